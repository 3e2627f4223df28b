#pragma once
// Remembers the strata that were fitted to surfaces, from one plan of rays to the next.
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "echopath/trace/launch/stratum.h"

namespace echopath {

// Not thread-safe. What one plan has asked for is known to the next one alone.
class FittedStrata {
 public:
  // Returns what fit_stratum (fit_stratum.h) returns.
  std::optional<Stratum> fit(const std::vector<Vec3>& vertices, const Vec3& apex, std::string name, bool may_be_strip);
  // Begins a plan.
  void begin_plan();

 private:
  using ByInput = std::unordered_map<uint64_t, std::optional<Stratum>>;  // by the sum of the bits of all arguments
  ByInput before_, now_;
};

}  // namespace echopath
