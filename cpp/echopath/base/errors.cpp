#include "echopath/base/errors.h"

#include <algorithm>

#include "echopath/base/text/edit_distance.h"

namespace echopath {

std::vector<std::string> nearest_names(std::string_view word, const std::vector<std::string>& candidates, int count) {
  using Rank = std::pair<bool, size_t>;  // not begun by the word, edits
  std::vector<std::pair<Rank, std::string>> ranked;
  ranked.reserve(candidates.size());
  for (const std::string& name : candidates) {
    ranked.emplace_back(Rank(word.empty() || !name.starts_with(word), edit_distance(word, name)), name);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  std::vector<std::string> nearest;
  for (size_t i = 0; i < std::min(ranked.size(), static_cast<size_t>(count)); ++i) nearest.push_back(ranked[i].second);
  return nearest;
}

}  // namespace echopath
