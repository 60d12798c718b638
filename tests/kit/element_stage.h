/* element_stage.h -- the kit's own elements around the one under test. */
#ifndef AMBIT_ELEMENT_STAGE_H
#define AMBIT_ELEMENT_STAGE_H
#include <ambit/element.h>

/* OUT frame 0: moves freely; its pose is written with Euler angles, twist and acceleration are differentiated from
** it. Joint 1, 6 degrees.
*/
extern const ambit_element element_stage_mover;
/* IN frame 0: an arbitrary wrench, parameter 0 [6]. */
extern const ambit_element element_stage_load;
/* a field, parameter 0 [3] */
extern const ambit_element element_stage_field;

#define ELEMENT_STAGE_PARAMS 2u /* that any of them has */

/* A joint with states (OUT; parameters 0 and 1: as many numbers other than 0 as it has speeds and coordinates), or an
** arbitrary effort on one (IN; parameter 0: one for each degree of freedom). dof: as in ambit_port.
*/
typedef struct element_stage_joint {
  ambit_element element;
  ambit_port port[1];
  ambit_param param[ELEMENT_STAGE_PARAMS + 1];
  char shape[8];
} element_stage_joint;
void element_stage_make_joint(element_stage_joint *j, uint32_t dof);
void element_stage_make_effort(element_stage_joint *j, uint32_t dof);
#endif
