#pragma once
// Chooses the paths of a record by which its frame is checked.
#include <cstdint>
#include <vector>

#include "echopath/trace/record/paths.h"

namespace echopath {

// Holds the paths to be checked, and how many of its kind each stands for.
struct PathSample {
  std::vector<int64_t> paths;
  std::vector<float> weights;
};

// Takes about every n-th path of each object and number of bounces, so that no more than kPathsChecked of them are checked,
// but every path that adds up as a field, since those would alias. Takes all paths where `all` is true.
PathSample sample_of(const Paths& paths, bool all);

}  // namespace echopath
