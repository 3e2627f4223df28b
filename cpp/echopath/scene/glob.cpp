#include <set>

#include "echopath/scene/scene.h"

namespace echopath {
namespace {

// On a mismatch only the latest star needs to take one character more, so the time is at most |glob| |name|.
bool matches(std::string_view glob, std::string_view name) {
  constexpr size_t kNone = std::string_view::npos;
  size_t g = 0, n = 0, star = kNone, resume = 0;
  while (n < name.size()) {
    if (g < glob.size() && glob[g] == '*') {
      star = g++;
      resume = n;
    } else if (g < glob.size() && (glob[g] == '?' || glob[g] == name[n])) {
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
