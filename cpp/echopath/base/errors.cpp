#include "echopath/base/errors.h"

#include <algorithm>
#include <numeric>

namespace echopath {
namespace {

size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

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
