#pragma once
// What functions that trace to a given error have in common.
#include <pybind11/pybind11.h>

#include <algorithm>
#include <optional>
#include <string>

#include "call/warn.h"
#include "echopath/sim/rays/trace_to_error.h"

namespace echopath::bindings {

// Rays and batches to begin with, and the target until which rays are added, if there is one.
struct Effort {
  int64_t num_rays;
  int batches;
  std::optional<ErrorTarget> target;
};

inline Effort toward(const ErrorTarget& target, std::optional<int64_t> num_rays, int batches) {
  return {num_rays.value_or(std::min(kFirstRays, target.max_rays)), batches, target};
}

// A target that was not met is said aloud, and may be made an error.
inline void warn_of_missed_target(const std::string& subject, double error_db, double target_error_db) {
  warn_caller(subject + " was reached at an error of " + std::to_string(error_db) + " dB, target_error_db is " +
              std::to_string(target_error_db));
}

}  // namespace echopath::bindings
