/* inverse_angle.c -- the preimage of an interval under cos, sin and tan within an interval of angles.
**
** cos is one to one on [k pi, (k+1) pi]; its preimage there is k pi + acos r (k even) or (k+1) pi - acos r (k odd), one
** connected branch. Branches ascend with k. From the branch that is surely not above the lower end of a, the first one
** that meets a gives the new lower end; likewise from above. Computed branches enclose the true ones, and the lower end
** of branch k is not above (k+1) pi, so stopping at the first that meets a loses no solution.
*/
#include "graph/contract.h"
#include "num/interval.h"

#define FAR 1e9 /* angles beyond: branches are too uncertain to be of use */

static ambit_interval times_pi(double k) { return ambit_interval_mul((ambit_interval) { k, k }, ambit_interval_pi()); }

/* branch number k, given the principal value */
typedef ambit_interval (*branch_fn)(double k, ambit_interval principal);

static ambit_interval cos_branch(double k, ambit_interval principal) {
  if (fmod(k, 2) == 0) return ambit_interval_add(times_pi(k), principal);
  return ambit_interval_sub(times_pi(k + 1), principal);
}

static ambit_interval tan_branch(double k, ambit_interval principal) {
  return ambit_interval_add(times_pi(k), principal);
}

/* from below: the first branch that meets a; false: all of them lie elsewhere */
static bool raise(branch_fn branch, ambit_interval principal, ambit_interval *a) {
  double first = floor(a->lo / 3.141592653589793) - 1;
  for (double k = first;; k++) {
    ambit_interval b = branch(k, principal);
    if (b.lo > a->hi) return false;
    if (b.hi < a->lo) continue;
    a->lo = fmax(a->lo, b.lo);
    return true;
  }
}

static bool lower(branch_fn branch, ambit_interval principal, ambit_interval *a) {
  double last = floor(a->hi / 3.141592653589793) + 1;
  for (double k = last;; k--) {
    ambit_interval b = branch(k, principal);
    if (b.hi < a->lo) return false;
    if (b.lo > a->hi) continue;
    a->hi = fmin(a->hi, b.hi);
    return true;
  }
}

static bool meet_branches(branch_fn branch, ambit_interval principal, ambit_interval *a) {
  if (ambit_interval_is_empty(principal)) return false;
  if (fabs(a->lo) < FAR && !raise(branch, principal, a)) return false;
  return !(fabs(a->hi) < FAR) || lower(branch, principal, a);
}

bool ambit_inverse_cos(ambit_interval r, ambit_interval *a) {
  ambit_interval principal;
  if (r.lo <= -1 && r.hi >= 1) return true;
  ambit_interval_op(AMBIT_OP_ACOS, &principal, r, r);
  return meet_branches(cos_branch, principal, a);
}

/* sin a = cos(a - pi/2) */
bool ambit_inverse_sin(ambit_interval r, ambit_interval *a) {
  ambit_interval quarter = ambit_interval_div(ambit_interval_pi(), (ambit_interval) { 2, 2 });
  ambit_interval turned = ambit_interval_sub(*a, quarter);
  if (!ambit_inverse_cos(r, &turned)) return false;
  *a = ambit_interval_intersect(*a, ambit_interval_add(turned, quarter));
  return !ambit_interval_is_empty(*a);
}

bool ambit_inverse_tan(ambit_interval r, ambit_interval *a) {
  ambit_interval principal;
  ambit_interval_op(AMBIT_OP_ATAN, &principal, r, r);
  return meet_branches(tan_branch, principal, a);
}
