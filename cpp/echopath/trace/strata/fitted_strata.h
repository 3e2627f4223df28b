#pragma once
// Remembers the strata that were fitted to surfaces, from one plan of rays to the next.
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "echopath/record/stratum.h"

namespace echopath {

// Keeps the strata that one plan of rays asked for until the next plan has asked. Threads may ask side by side,
// while no plan begins.
class FittedStrata {
 public:
  using Fitted = std::optional<Stratum>;
  // Begins a plan.
  void begin_plan();
  // Returns what was fitted to the same input before, else what `fit` returns. `input` is the sum of the bits of all that
  // the stratum depends on (base/bit_sum.h).
  Fitted find(uint64_t input, const std::function<Fitted()>& fit);

 private:
  std::unordered_map<uint64_t, Fitted> before_, now_;  // by input
  std::mutex now_mutex_;
};

}  // namespace echopath
