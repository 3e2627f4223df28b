#include "echopath/base/text/nearest_names.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "echopath/base/text/edit_distance.h"

namespace echopath {
namespace {

// Returns how many letters the parts have that two paths share from their beginning, each with the slash after it. Letters
// of a part that they share no further tell nothing: a typo may stand early in it.
size_t shared_path(std::string_view a, std::string_view b) {
  const auto end = std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first;
  const std::string_view shared = a.substr(0, static_cast<size_t>(end - a.begin()));
  const size_t slash = shared.rfind('/');
  return slash == std::string_view::npos ? 0 : slash + 1;
}

// Returns the word without wildcards, and without slashes at its ends.
std::string without_wildcards(std::string_view word) {
  std::string plain;
  for (const char letter : word) {
    if (letter != '*' && letter != '?') plain += letter;
  }
  const size_t begin = plain.find_first_not_of('/'), end = plain.find_last_not_of('/');
  return begin == std::string::npos ? "" : plain.substr(begin, end - begin + 1);
}

std::string_view last_part(std::string_view path) { return path.substr(path.rfind('/') + 1); }

// Returns the fewest edits between a word and a path, or between their last parts, or to a word of that of the path, such as
// arm of walker/arm_left. Parts before the last are names of their own.
size_t edits_of_path(std::string_view word, std::string_view name) {
  constexpr size_t kPart = 1;  // edits that these count for: the whole name comes first among equals
  size_t fewest = edit_distance(word, name);
  const std::string plain = without_wildcards(word);
  const std::string_view asked = last_part(plain), part = last_part(name);
  if (asked.empty() || part.size() == name.size()) return fewest;
  for (size_t begin = 0; begin < part.size(); ++begin) {
    if (begin > 0 && part[begin - 1] != '_') continue;
    for (size_t end = begin + 1; end <= part.size(); ++end) {
      if (end < part.size() && part[end] != '_') continue;
      fewest = std::min(fewest, edit_distance(asked, part.substr(begin, end - begin)) + kPart);
    }
  }
  return fewest;
}

}  // namespace

std::vector<std::string> nearest_names(std::string_view word, const std::vector<std::string>& candidates, int count) {
  // A rank tells whether the name does not begin with the word, how many letters lie outside the parts that the two paths
  // share, and the edits between them.
  using Rank = std::tuple<bool, size_t, size_t>;
  std::vector<std::pair<Rank, std::string>> ranked;
  ranked.reserve(candidates.size());
  for (const std::string& name : candidates) {
    const bool begins = !word.empty() && name.starts_with(word);
    ranked.emplace_back(Rank(!begins, word.size() - shared_path(word, name), edits_of_path(word, name)), name);
  }
  std::ranges::stable_sort(ranked, [](const auto& x, const auto& y) { return x.first < y.first; });
  std::vector<std::string> nearest;
  for (size_t i = 0; i < std::min(ranked.size(), static_cast<size_t>(count)); ++i) nearest.push_back(ranked[i].second);
  return nearest;
}

}  // namespace echopath
