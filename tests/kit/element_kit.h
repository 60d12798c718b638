/* element_kit.h -- the conformance kit for element plugins: hand it any element and it says whether it keeps the
** contract.
**
** The element is put on a stage: each of its IN frames is carried by a frame that moves freely in space, each of its
** OUT frames carries an arbitrary wrench, each joint an arbitrary effort, in a field of gravity; parameters are
** random, in every combination of the optional ones, at rest and moving in time. Everything that the element
** expresses is compared with what follows from its poses by differentiation, at random points, with enclosures: the
** difference must contain 0 and be narrow. Formulas with abs, min and max are differentiated off the places where they
** switch; some of the points lie close to rest, on both sides of it.
**
**   description   names, units, shapes, fallbacks, one sentence each
**   quantities    each is expressed, declined, or refused by a message that names the part; unknown ones are declined
**   pose          a proper rotation
**   twist         R^T R' and R^T r'
**   acceleration  w' and v' + w x v - R^T g
**   joints        rates are the derivatives of the coordinates; with fewer speeds than coordinates (AMBIT_DOF) they
**                 are what AMBIT_COORDINATE_RATE says, and the variables of a row without multiplier a unit vector
**   power         element_kit_power.c: wrenches, efforts, multipliers, AMBIT_ENERGY and AMBIT_POWER fit together
**   momentum      element_kit_momentum.c: action and reaction; AMBIT_MASS, AMBIT_MASS_MOMENT, AMBIT_MOMENTUM
*/
#ifndef AMBIT_ELEMENT_KIT_H
#define AMBIT_ELEMENT_KIT_H
#include <ambit/element.h>

typedef struct element_kit_report {
  unsigned stages;                       /* combinations of parameters */
  unsigned expressed, refused, declined; /* quantities, over all stages */
  unsigned own;                          /* of these, what the element itself has written */
  unsigned compared;                     /* numbers that had to vanish, over all stages and points */
  unsigned powers, reactions;            /* balances of power and of momentum that were closed */
  unsigned failures;
  char first[600]; /* the first failure */
} element_kit_report;

element_kit_report element_kit_run(const ambit_element *element, const char *name, uint64_t seed);
#endif
