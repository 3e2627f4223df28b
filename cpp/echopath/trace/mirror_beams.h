#pragma once
// What an antenna lights over sequences of mirrors: its images, each with the window through which it is seen.
// Source: beam tracing after Heckbert, Hanrahan 1984.
#include <cstdint>
#include <limits>
#include <vector>

#include "echopath/trace/mirrors.h"

namespace echopath {

inline constexpr int kMaxLegMirrors = 2;  // mirrors between a surface point and an antenna

// A sequence of mirrors in travel order from the antenna to the surface, as a number. 0: none.
using MirrorSequence = int64_t;
inline constexpr MirrorSequence kDirect = 0;
inline constexpr MirrorSequence kLongSequence = -2;  // of more than kMaxLegMirrors, which have no number
// `sequence` and then `mirror` (an index into `num_mirrors` mirrors).
inline MirrorSequence extended(MirrorSequence sequence, int mirror, size_t num_mirrors) {
  return sequence * (static_cast<MirrorSequence>(num_mirrors) + 1) + mirror + 1;
}

struct Beam {
  MirrorSequence sequence = kDirect;
  std::vector<int> mirrors;   // in travel order from the antenna
  std::vector<Vec3> images;   // of the antenna over the first 1, 2, .. of them
  Vec3 lit_normal;            // of the last mirror, unit, on the side that is lit
  double offset = 0.0;        // of its plane: lit_normal.dot(p) > offset is lit
  std::vector<Vec3> window;   // corners of what the last image is seen through, on the last mirror
  std::vector<Vec3> rims;     // inward unit normals of the planes through the last image and an edge of the window

  const Vec3& image() const { return images.back(); }
  // A ball about `point` reaches into the beam, `radius` in m. True for all that is lit and for little else: that the mirrors
  // have no holes and nothing stands in the way is for rays to find out.
  bool reaches(const Vec3& point, double radius) const;
};

// The beams of an antenna over sequences of at most `max_mirrors` mirrors, by number of mirrors and then by mirrors in
// travel order; sequences that light nothing are left out, and so are the last of more than `max_beams`.
std::vector<Beam> find_beams(const Vec3& antenna, const std::vector<Mirror>& mirrors, int max_mirrors,
                             size_t max_beams = std::numeric_limits<size_t>::max());

}  // namespace echopath
