#pragma once
// Draws statistics of the training cells of a CFAR window from the distribution in which false alarms happen: there they are
// low, so that a weight times the probability of a false alarm hardly varies.
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/spectrum/cfar_factor/drawn_powers.h"

namespace echopath {

struct TrainingDraw {
  double statistic = 0.0;   // of the method, for cells of unit mean power per channel
  double log_weight = 0.0;  // a mean over the noise weighs the draw by e^this
};

// Names cells that are low together: noise is tilted by e^{-tilt times the sum of their powers}.
struct TiltedGroup {
  CellGroup cells;
  Eigen::MatrixXd form;  // of the sum
  double tilt = 0.0;
};

// Returns `count` draws from a mixture over groups, in equal shares; weights undo it exactly. Draws are always the same and
// do not depend on the number of threads. Raises Cancelled.
std::vector<TrainingDraw> draws_of_groups(const CfarDesign& design, const TrainingNoise& noise,
                                          const std::vector<TiltedGroup>& groups, int count, Job* job);

// Returns draws for an ordered statistic, of which order() cells are low, but not always the same: each draw tilts others,
// which are chosen by chance. Costs the cube of the number of training cells for each. Otherwise as draws_of_groups.
std::vector<TrainingDraw> draws_of_chosen_cells(const CfarDesign& design, const TrainingNoise& noise, double tilt, int count,
                                                Job* job);

}  // namespace echopath
