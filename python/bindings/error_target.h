#pragma once
// What functions that trace to a given error have in common.
#include <pybind11/pybind11.h>

#include <algorithm>
#include <optional>
#include <string>

#include "echopath/sim/trace_to_error.h"

namespace echopath::bindings {

// Rays and batches that were asked for, or those that a target starts with; the defaults are for calls without one.
struct Effort {
  int64_t num_rays;
  int batches;
  std::optional<ErrorTarget> target;
};

inline Effort effort_of(std::optional<int64_t> num_rays, std::optional<int> batches, std::optional<double> target_error_db,
                        int64_t max_rays, int64_t default_rays, int default_batches) {
  if (!target_error_db) return {num_rays.value_or(default_rays), batches.value_or(default_batches), std::nullopt};
  return {num_rays.value_or(std::min(kFirstRays, max_rays)), batches.value_or(kTargetBatches),
          ErrorTarget{*target_error_db, max_rays}};
}

// A target that was not met is said aloud, and may be made an error. Called by what Python wraps once.
inline void warn_of_missed_target(const std::string& subject, double error_db, double target_error_db) {
  const std::string text = subject + " was reached at a standard error of " + std::to_string(error_db) +
                           " dB, target_error_db is " + std::to_string(target_error_db);
  if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), 2) != 0) throw pybind11::error_already_set();
}

}  // namespace echopath::bindings
