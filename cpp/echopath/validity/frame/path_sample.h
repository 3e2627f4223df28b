#pragma once
// Chooses the paths of a record by which its frame is checked.
#include <cstdint>
#include <vector>

#include "echopath/record/paths.h"

namespace echopath {

// Holds the paths to be checked, and how many of its kind each stands for.
struct PathSample {
  std::vector<int64_t> paths;
  std::vector<float> weights;
};

// Takes all coherent paths, whose sums would alias, and of the diffuse ones of each object and number of bounces about every
// n-th, at most kPathsChecked. Takes all paths where `all` is true.
PathSample sample_of(const Paths& paths, bool all);

}  // namespace echopath
