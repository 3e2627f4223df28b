#include "echopath/trace/launch/fitted_strata.h"

#include <utility>

#include "echopath/base/bit_sum.h"
#include "echopath/trace/launch/fit_stratum.h"

namespace echopath {

std::optional<Stratum> FittedStrata::fit(const std::vector<Vec3>& vertices, const Vec3& apex, std::string name,
                                         bool may_be_strip) {
  BitSum bits;
  bits.add_bytes(vertices.data(), vertices.size() * sizeof(Vec3));
  bits.add_bytes(apex.data(), sizeof(Vec3));
  bits.add_bytes(name.data(), name.size());
  bits.add(may_be_strip);
  const auto known = before_.find(bits.value());
  std::optional<Stratum> fitted =
      known != before_.end() ? known->second : fit_stratum(vertices, apex, std::move(name), may_be_strip);
  return now_.insert_or_assign(bits.value(), std::move(fitted)).first->second;
}

void FittedStrata::begin_plan() {
  before_ = std::move(now_);
  now_.clear();
}

}  // namespace echopath
