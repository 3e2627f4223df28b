#pragma once
// The arguments `period` and `offset` of what is played.
#include <pybind11/pybind11.h>

#include <optional>

#include "echopath/base/errors.h"
#include "echopath/motion/curve.h"

namespace echopath::bindings {

inline Playback playback_of(const std::optional<double>& period, double offset) {
  const Playback playback{offset, period.value_or(0.0)};
  require(!period || *period > 0.0, "period", "must be 1e-6 to 1e9 s, or None", period.value_or(0.0));
  playback.validate();
  return playback;
}

inline pybind11::object period_of(const Playback& playback) {
  return playback.period > 0.0 ? pybind11::object(pybind11::float_(playback.period)) : pybind11::object(pybind11::none());
}

}  // namespace echopath::bindings
