#pragma once
// One echo for paths over the same hits. A rough surface sends a coherent and a diffuse path back from each point where a ray
// meets it: their lengths are the same at all times and for all antennas, and what is synthesised is the sum of their amplitudes.
#include <span>
#include <vector>

#include "echopath/replay/posed/local_paths.h"
#include "echopath/replay/posed/specular_slide.h"
#include "echopath/signal/echoes.h"

namespace echopath {

class JoinRule {
 public:
  // labels: [P] each; paths that differ in one of them stay apart. All must outlive the rule.
  JoinRule(const Paths& paths, const PathPreparer& preparer, SpecularPoints specular,
           std::vector<const std::vector<uint32_t>*> labels);

  // For each path but the first whether it makes one echo with the one before: same hits, of which the same ones are images in
  // mirrors, same ray, same end at which it began. Nothing is joined where specular hits move with the point of reflection, which
  // hits do not tell.
  std::vector<uint8_t> operator()(std::span<const int64_t> paths) const;

 private:
  bool is_joined(size_t before, size_t path) const;
  bool has_same_images(size_t before, size_t path) const;

  const Paths& paths_;
  const PathPreparer& preparer_;
  bool slides_;
  std::vector<const std::vector<uint32_t>*> labels_;
};

// The echo of each path; empty where `joined` is.
std::vector<uint32_t> echoes_of(std::span<const uint8_t> joined);
// joined: [echo] of `all`, 1 where it goes into the one before. `to`: [num_nodes, echoes that are left], sized by the caller.
void join(const Echoes& all, std::span<const uint8_t> joined, Echoes& to);
// The first path of each echo that is left.
std::vector<int64_t> first_of(std::span<const int64_t> paths, std::span<const uint8_t> joined);

}  // namespace echopath
