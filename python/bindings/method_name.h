#pragma once
#include <stdexcept>
#include <string>

#include "echopath/signal/synthesizer.h"

namespace echopath::bindings {

// The method of synthesis by its name in Python; raises invalid_argument for another name.
inline Method as_method(const std::string& name) {
  if (name == "auto") return Method::kAuto;
  if (name == "direct") return Method::kDirect;
  if (name == "recurrence") return Method::kRecurrence;
  if (name == "nufft") return Method::kNufft;
  throw std::invalid_argument("method: must be 'auto', 'direct', 'recurrence' or 'nufft', got '" + name + "'");
}

}  // namespace echopath::bindings
