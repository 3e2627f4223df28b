#pragma once
#include <string>

namespace echopath::bindings {

// Gives a RuntimeWarning at the line outside of the package from which it was called, however deep within the package the
// work goes on. Raises it where warnings are errors.
void warn_caller(const std::string& text);

}  // namespace echopath::bindings
