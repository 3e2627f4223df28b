#include "echopath/trace/strata/fitted_strata.h"

#include <utility>

namespace echopath {

void FittedStrata::begin_plan() {
  before_ = std::move(now_);
  now_.clear();
}

FittedStrata::Fitted FittedStrata::find(uint64_t input, const std::function<Fitted()>& fit) {
  const auto known = before_.find(input);
  Fitted fitted = known != before_.end() ? known->second : fit();
  const std::lock_guard lock(now_mutex_);
  return now_.insert_or_assign(input, std::move(fitted)).first->second;
}

}  // namespace echopath
