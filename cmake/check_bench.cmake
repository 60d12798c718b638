# cmake -DCOMMAND=ambit -DPROGRAM=x.lua -DWORDS=... -P check_bench.cmake: exit code 0, 1 for a figure that this machine
# misses, or 3 where a run is followed until nothing more can be proved; a table; no Lua error.
execute_process(COMMAND ${COMMAND} run --quiet ${PROGRAM} ${WORDS} OUTPUT_VARIABLE out ERROR_VARIABLE err RESULT_VARIABLE code)
if(NOT code MATCHES "^[013]$" OR err MATCHES "stack traceback|ambit: [^\n]*\\.lua:[0-9]+:")
  message(FATAL_ERROR "${PROGRAM}: exit code ${code}\n${out}\n${err}")
endif()
if(NOT out MATCHES "\n\\|---.*\n\\| [^\n]* \\|")
  message(FATAL_ERROR "${PROGRAM}: no table\n${out}\n${err}")
endif()
