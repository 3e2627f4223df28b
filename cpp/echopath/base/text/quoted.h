#pragma once
// Writes text as messages repeat it.
#include <array>
#include <cstdio>
#include <string>

namespace echopath {

// Returns the text in quotes, its control characters as escapes: 'a\x00b'.
inline std::string quoted(const std::string& text) {
  std::string shown = "'";
  for (const char sign : text) {
    const auto code = static_cast<unsigned char>(sign);
    if (code >= 0x20 && code != 0x7f) {
      shown += sign;
      continue;
    }
    std::array<char, 5> escape;
    std::snprintf(escape.data(), escape.size(), "\\x%02x", code);
    shown += escape.data();
  }
  return shown + "'";
}

}  // namespace echopath
