/* code.h -- the codes of outcomes: what a program compares instead of sentences, which may change.
**
** A code is a word of its status, then, if more is known, a dot and what happened: "unable.width". The first word never
** changes its meaning; new codes may follow it. `ambit errors CODE` and docs/errors.md print this table, which is the
** only one. A plugin may make codes of its own behind the word of its status ("unable.my-solver-diverged"); the kernel
** replaces one of another form by the status alone.
*/
#ifndef AMBIT_CODE_H
#define AMBIT_CODE_H
#include <ambit/base.h>

#define AMBIT_CODE_MAX 48 /* bytes of a code, with its end */

/* X(NAME, "code", what it means, what to do) */
#define AMBIT_CODES(X)                                                                                                 \
  X(OK, "ok", "Done, and proved wherever the method proves at all.", "")                                               \
  X(OK_EXPECTED, "ok.expected", "Not proved, or above its bound, as the scene expected (`expect`).", "")               \
  X(OK_NONE, "ok.none", "The question was whether something exists, and it is proved that nothing does.", "")          \
  X(OK_PARTIAL, "ok.partial",                                                                                          \
      "For a part of the data there is no answer, and the scene said `partial = true`: it knows.", "")                 \
  X(OK_REFUTED, "ok.refuted", "A counterexample is proved: the condition does not hold for all data.",                 \
      "Look at the counterexample.")                                                                                   \
  X(DOMAIN, "domain", "Proved: there is no answer.", "Mend the data or the question.")                                 \
  X(DOMAIN_CONSTRAINT, "domain.constraint",                                                                            \
      "Proved: no initial state meets a constraint of the mechanism, so there is no motion.",                          \
      "Give initial values that fit; m:assemble finds them.")                                                          \
  X(DOMAIN_UNDEFINED, "domain.undefined",                                                                              \
      "Proved: an expression is defined for none of the data (log of a "                                               \
      "negative number).",                                                                                             \
      "Look at the operation that the reason names.")                                                                  \
  X(UNABLE, "unable", "Neither proved nor refuted.", "The reason says what stood in the way.")                         \
  X(UNABLE_BOUND, "unable.bound", "An error could not be proved to stay below the bound asked for.",                   \
      "Ask for a larger bound, or leave less out.")                                                                    \
  X(UNABLE_BUDGET, "unable.budget", "The budget was spent before all was decided.", "Raise `budget`.")                 \
  X(UNABLE_BOXES_MAX, "unable.boxes-max", "The search for roots took as many boxes as it may.",                        \
      "Raise `boxes_max`, search a smaller box, or narrow the data.")                                                  \
  X(UNABLE_CONSTRAINT, "unable.constraint", "No state of the enclosure meets a constraint later on.",                  \
      "No initial state does, or the equations of motion do not keep it.")                                             \
  X(UNABLE_SHORT_STEPS, "unable.short-steps", "Steps became so short that the end is out of reach.",                   \
      "Split the initial set, raise `tolerance`, or end before it.")                                                   \
  X(UNABLE_EIGENVALUES, "unable.eigenvalues", "No enclosure of the eigenvalues was found.", "Narrow the data.")        \
  X(UNABLE_EVENT, "unable.event",                                                                                      \
      "It could not be proved whether, or for all data, an event happens that the run depends on.",                    \
      "Narrow the data, or end the run before it.")                                                                    \
  X(UNABLE_EVENTS_MAX, "unable.events-max", "There are more events than a run records.", "Ask for a shorter run.")     \
  X(UNABLE_FURTHER, "unable.further", "More equations than unknowns, and those left over could not be proved.",        \
      "Leave out equations that follow from the others.")                                                              \
  X(UNABLE_INITIAL, "unable.initial", "The initial values are not defined for all their data, or too large.",          \
      "Narrow the ranges of the data in `initial`.")                                                                   \
  X(UNABLE_KINK, "unable.kink", "The set reaches the kink of an element's law.",                                       \
      "End before it, leave out `solver` so that one that crosses kinks is taken, or put a smooth law in its place.")  \
  X(UNABLE_VARYING, "unable.varying", "A datum varies in time, and the solver takes data for constants.",              \
      "Leave out `solver`, or name one that takes what varies.")                                                       \
  X(UNABLE_SAMPLED, "unable.sampled", "The system is sampled, and the solver takes states that never jump.",           \
      "Leave out `solver`, or name one that takes sampled systems.")                                                   \
  X(UNABLE_ORIENTATION, "unable.orientation", "An orientation could not be told from its opposite.",                   \
      "Narrow the data.")                                                                                              \
  X(UNABLE_PARTIAL, "unable.partial",                                                                                  \
      "For a part of the data there is no answer; what is returned holds for the rest.",                               \
      "Narrow the data, or say `partial = true` if that is what you want.")                                            \
  X(UNABLE_UNEXPECTED, "unable.unexpected", "The verdict is another one than the scene expected (`expect`).",          \
      "Look at the reason; mend the scene or what it expects.")                                                        \
  X(UNABLE_RATES, "unable.rates", "The rates are too large for the length of the step.", "Lower `step_max`.")          \
  X(UNABLE_ROOTS_MAX, "unable.roots-max", "There are more roots than may be kept.",                                    \
      "Raise `roots_max`, or search a smaller box.")                                                                   \
  X(UNABLE_SEARCH_UNBOUNDED, "unable.search-unbounded", "Boxes that reach to infinity were left undecided.",           \
      "Search a bounded box.")                                                                                         \
  X(UNABLE_STEP, "unable.step", "No step of at least the least length could be proved.",                               \
      "Split the initial set, lower `step_min`, raise `tolerance`, or end before it.")                                 \
  X(UNABLE_STEPS_MAX, "unable.steps-max", "More steps were needed than `steps_max`.", "Raise `steps_max`.")            \
  X(UNABLE_SWITCH, "unable.switch", "It could not be proved which way a hybrid system goes at a guard.",               \
      "Narrow the data; see the reason.")                                                                              \
  X(UNABLE_SWITCHES_MAX, "unable.switches-max", "More switches than `switches_max`.", "Raise `switches_max`.")         \
  X(UNABLE_UNDECIDED, "unable.undecided", "A box or a part of the data was neither proved nor excluded.",              \
      "Lower `tolerance`, or narrow the data.")                                                                        \
  X(UNABLE_UNDECIDED_MAX, "unable.undecided-max", "More boxes were left undecided than are kept.",                     \
      "Narrow the data, or raise `tolerance` or `undecided_max`.")                                                     \
  X(UNABLE_UNDEFINED, "unable.undefined", "The right-hand side could not be bounded over the set.",                    \
      "Split the initial set, or end before it.")                                                                      \
  X(UNABLE_WIDTH, "unable.width", "The enclosure grew wider than `width_max`.",                                        \
      "Split the initial set, or allow more by `width_max`.")                                                          \
  X(INVALID, "invalid", "The script or its input is wrong; the sentence says where.", "Mend it.")                      \
  X(INVALID_EXIT, "invalid.exit", "Something ended the process by exit() while Ambit was at work.",                    \
      "Leave a scene by os.exit or by its end, never by exit() in a plugin.")                                          \
  X(MEMORY, "memory", "There was not enough memory.", "Make fewer data uncertain, or allow more memory.")              \
  X(STOPPED, "stopped", "Stopped before the end.", "What was recorded until then holds.")                              \
  X(STOPPED_LIMIT, "stopped.limit", "A limit that the scene or the command gave is used up.", "Raise the limit.")      \
  X(STOPPED_MEMORY, "stopped.memory", "The limit of --memory is reached.", "Raise the limit, or ask for less.")        \
  X(STOPPED_OUTPUT, "stopped.output", "The limit of --output is reached.", "Raise the limit, or print less.")          \
  X(STOPPED_REQUEST, "stopped.request",                                                                                \
      "Somebody asked for it: Ctrl-C, SIGTERM or SIGHUP; or nobody reads what is printed (SIGPIPE).", "")              \
  X(STOPPED_TIME, "stopped.time", "The limit of --time is reached.", "Raise the limit, or ask for less.")              \
  X(STOPPED_WRITE, "stopped.write", "The records could not be written.", "Make room, or write them elsewhere.")        \
  X(BROKEN, "broken", "A plugin contradicts itself: nothing that it says is a proof.", "Tell its author.")             \
  X(BROKEN_BOUNDS, "broken.bounds", "A plugin gave bounds that are empty, inverted or NaN.", "Tell its author.")       \
  X(BROKEN_CONTRADICTION, "broken.contradiction",                                                                      \
      "Two proofs, or a proof and a reference or sample, contradict each other.",                                      \
      "If the reference is right, a plugin or Ambit is wrong: report it.")                                             \
  X(BROKEN_RECORD, "broken.record", "A solver gave a record of the wrong form.", "Tell its author.")                   \
  X(BROKEN_ROUNDING, "broken.rounding", "This build or machine does not round as told.",                               \
      "Build without options that change floating point.")                                                             \
  X(BROKEN_TIME, "broken.time", "A solver left a gap in time, went backwards, or did not reach the end.",              \
      "Tell its author.")

/* AMBIT_CODE_UNABLE_WIDTH and so on */
#if defined(__GNUC__)
#define AMBIT_CODE_X(name, code, meaning, advice)                                                                      \
  __attribute__((__unused__)) static const char AMBIT_CODE_##name[] = code;
#else
#define AMBIT_CODE_X(name, code, meaning, advice) static const char AMBIT_CODE_##name[] = code;
#endif
AMBIT_CODES(AMBIT_CODE_X)
#undef AMBIT_CODE_X
#endif
