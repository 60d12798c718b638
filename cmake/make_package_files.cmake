# cmake -DAMBIT=<command> -DTREE=<source tree> -DMADE=<folder> -DGZIP=<gzip> -DVERSION=<version> -DCONTACT=<who> -P make_package_files.cmake: manual page,
# completions, and what Debian wants to find beside a package.
file(MAKE_DIRECTORY ${MADE})

function(make name)
  execute_process(COMMAND ${AMBIT} run --quiet ${ARGN} OUTPUT_FILE ${MADE}/${name} RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${name} could not be made")
  endif()
endfunction()

function(zip name)
  execute_process(COMMAND ${GZIP} -9nf ${MADE}/${name} RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${name} could not be packed: gzip is needed")
  endif()
endfunction()

make(ambit.1 ${TREE}/scripts/package/man.lua ${AMBIT})
make(ambit.bash ${TREE}/scripts/package/completion.lua ${AMBIT} bash)
make(_ambit ${TREE}/scripts/package/completion.lua ${AMBIT} zsh)
zip(ambit.1)
configure_file(${TREE}/CHANGELOG.md ${MADE}/changelog COPYONLY)
zip(changelog)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC) # SOURCE_DATE_EPOCH, where it is set
file(WRITE ${MADE}/changelog.Debian "ambit (${VERSION}) unstable; urgency=medium\n\n  * See changelog.gz.\n\n -- ${CONTACT}  ${date}\n")
zip(changelog.Debian)

# .reuse/dep5 is in Debian's format, without the texts of the licences.
file(READ ${TREE}/.reuse/dep5 copyright)
string(APPEND copyright "\nLicense: Apache-2.0\n On Debian systems the text is in /usr/share/common-licenses/Apache-2.0.\n")
foreach(license MIT BSD-3-Clause)
  file(READ ${TREE}/LICENSES/${license}.txt text)
  string(STRIP "${text}" text)
  string(REGEX REPLACE "\n[ \t]*\n" "\n.\n" text "${text}")
  string(REPLACE "\n" "\n " text "${text}")
  string(APPEND copyright "\nLicense: ${license}\n ${text}\n")
endforeach()
file(WRITE ${MADE}/copyright "${copyright}")
file(WRITE ${MADE}/triggers "activate-noawait ldconfig\n")
