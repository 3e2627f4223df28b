#pragma once
// Which paths of a trace are meant: path expressions and their and, or, not. One language for select, partition and
// decompose.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "echopath/base/job.h"
#include "echopath/trace/paths.h"

namespace echopath {

// An immutable value, cheap to copy. Knows names only: it serves any scene that has the meshes it names.
class Selection {
 public:
  // A path expression (label/expression.h). Implicit, so that text may stand wherever a selection is asked for.
  Selection(std::string_view path_expression);
  Selection(const std::string& path_expression) : Selection(std::string_view(path_expression)) {}
  Selection(const char* path_expression) : Selection(std::string_view(path_expression)) {}

  static Selection path_expression(std::string_view text) { return Selection(text); }
  // Paths with at least one hit on a mesh that the glob takes: T .* 'glob' .* R.
  static Selection touches(std::string_view glob);
  // Paths of min to max hits, both included; without max any number from min on. 0 <= min <= max <= 64.
  static Selection num_bounces(int min, std::optional<int> max = std::nullopt);

  friend Selection operator&(const Selection& a, const Selection& b);
  friend Selection operator|(const Selection& a, const Selection& b);
  friend Selection operator~(const Selection& a);

  // [P] 1 where the path is selected, else 0. Raises invalid_argument when a glob takes no mesh of the paths' scene,
  // Cancelled when the job is.
  std::vector<uint8_t> matches(const Paths& paths, Job* job = nullptr) const;
  // As written; combined ones as (T . R) & ~(T .* 'wall' .* R).
  std::string text() const;

 private:
  struct Term;
  explicit Selection(std::shared_ptr<const Term> term) : term_(std::move(term)) {}
  std::shared_ptr<const Term> term_;
};

}  // namespace echopath
