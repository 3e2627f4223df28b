#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>

namespace echopath::test {

// The call raises Error with a text that has every one of the pieces.
template <class Error>
void expect_error(const std::function<void()>& call, std::initializer_list<std::string> pieces) {
  try {
    call();
  } catch (const Error& error) {
    for (const std::string& piece : pieces) {
      EXPECT_NE(std::string(error.what()).find(piece), std::string::npos) << "'" << piece << "' in: " << error.what();
    }
    return;
  }
  ADD_FAILURE() << "no error that speaks of " << *pieces.begin();
}

// Returns the text of the invalid_argument that the call raises.
inline std::string error_text(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace echopath::test
