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

}  // namespace

std::vector<std::string> nearest_names(std::string_view word, const std::vector<std::string>& candidates, int count) {
  // Whether the name does not begin with the word, letters outside the parts that the two paths share, edits between them.
  using Rank = std::tuple<bool, size_t, size_t>;
  std::vector<std::pair<Rank, std::string>> ranked;
  ranked.reserve(candidates.size());
  for (const std::string& name : candidates) {
    const bool begins = !word.empty() && name.starts_with(word);
    ranked.emplace_back(Rank(!begins, word.size() - shared_path(word, name), edit_distance(word, name)), name);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  std::vector<std::string> nearest;
  for (size_t i = 0; i < std::min(ranked.size(), static_cast<size_t>(count)); ++i) nearest.push_back(ranked[i].second);
  return nearest;
}

}  // namespace echopath
