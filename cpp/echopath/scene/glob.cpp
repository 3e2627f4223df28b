#include <set>

#include "echopath/scene/scene.h"

namespace echopath {
namespace {

// Names are UTF-8, of whose characters all bytes but the first are 10xxxxxx.
bool begins_character(char byte) { return (byte & 0xc0) != 0x80; }

size_t end_of_character(std::string_view name, size_t n) {
  do ++n;
  while (n < name.size() && !begins_character(name[n]));
  return n;
}

// On a mismatch only the latest star needs to take one character more, so the time is at most |glob| |name|.
bool matches(std::string_view glob, std::string_view name) {
  constexpr size_t kNone = std::string_view::npos;
  size_t g = 0, n = 0, star = kNone, resume = 0;
  while (n < name.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      resume = n;
    } else if (g < glob.size() && glob[g] == '?' && begins_character(name[n])) {
      ++g;
      n = end_of_character(name, n);
    } else if (g < glob.size() && glob[g] == name[n]) {
      ++g, ++n;
    } else if (star != kNone) {
      g = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  return glob.find_first_not_of('*', g) == kNone;
}

}  // namespace

bool glob_takes(std::string_view glob, std::string_view full_name) {
  for (size_t end = full_name.find('/'); end != std::string_view::npos; end = full_name.find('/', end + 1)) {
    if (matches(glob, full_name.substr(0, end))) return true;
  }
  return matches(glob, full_name);
}

std::vector<std::string> names_with_ancestors(const std::vector<std::string>& mesh_names) {
  std::set<std::string> names;
  for (const std::string& name : mesh_names) {
    for (size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
      names.insert(name.substr(0, slash));
    }
    names.insert(name);
  }
  return {names.begin(), names.end()};
}

}  // namespace echopath
