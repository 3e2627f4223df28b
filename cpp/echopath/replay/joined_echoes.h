#pragma once
// Joins paths over the same hits into one echo. A rough surface sends a coherent and a diffuse path back from each point
// where a ray meets it: their lengths are the same at all times and for all antennas, so the echo is synthesised once with
// the sum of their amplitudes.
#include <span>
#include <vector>

#include "echopath/replay/posed/local_paths.h"
#include "echopath/replay/posed/specular_slide.h"
#include "echopath/signal/echoes/echoes.h"

namespace echopath {

class JoinRule {
 public:
  // `labels` are [P] each; paths that differ in one of them stay apart. All must outlive the rule.
  JoinRule(const Paths& paths, const PathPreparer& preparer, SpecularPoints specular,
           std::vector<const std::vector<uint32_t>*> labels);

  // Returns for each path whether it makes one echo with the path before it (the first never does). Two paths do when they
  // have the same hits, the same images in mirrors, the same ray and the same end at which they began, and no sheets on
  // their ways. Paths with a lobe (lobe_factors.h) stay apart, because their amplitudes are multiplied by it. No paths are
  // joined where specular hits move with the point of reflection, because the hits do not tell where that lies.
  std::vector<uint8_t> operator()(std::span<const int64_t> paths) const;

 private:
  bool is_joined(size_t before, size_t path) const;
  bool has_same_images(size_t before, size_t path) const;

  const Paths& paths_;
  const PathPreparer& preparer_;
  bool slides_;
  std::vector<const std::vector<uint32_t>*> labels_;
};

// Returns the index of the echo of each path; it is empty where `joined` is.
std::vector<uint32_t> echoes_of(std::span<const uint8_t> joined);
// `joined` has one entry for each echo of `all`, 1 where it is added to the echo before it. The caller sizes `to` as
// [num_rows, echoes that are left].
void join(const Echoes& all, std::span<const uint8_t> joined, Echoes& to);
// Returns the first path of each echo that is left.
std::vector<int64_t> first_of(std::span<const int64_t> paths, std::span<const uint8_t> joined);

}  // namespace echopath
