#pragma once
// Finds what an antenna lights over sequences of mirrors: its images, each with the window through which it is seen. Source:
// beam tracing after Heckbert, Hanrahan 1984.
#include <cstdint>
#include <memory>
#include <vector>

#include "echopath/trace/frusta/frustum_shadows.h"
#include "echopath/trace/geometry/box_hierarchy.h"
#include "echopath/trace/mirrors/mirrors.h"

namespace echopath {

inline constexpr int kMaxLegMirrors = 2;       // mirrors between a surface point and an antenna
inline constexpr size_t kMaxFrusta = 250'000;  // of one antenna, about 0.2 GiB; those left out are counted

// A sequence of mirrors in travel order from the antenna to the surface is kept as a number; 0 means no mirror.
using MirrorSequence = int64_t;
inline constexpr MirrorSequence kNoMirrors = 0;
inline constexpr MirrorSequence kLongSequence = -2;  // of more than kMaxLegMirrors, which have no number
// Returns `sequence` followed by `mirror` (an index into `num_mirrors` mirrors).
inline MirrorSequence extended(MirrorSequence sequence, int mirror, size_t num_mirrors) {
  return sequence * (static_cast<MirrorSequence>(num_mirrors) + 1) + mirror + 1;
}

// Describes the space that an antenna lights over one sequence of mirrors: all that lies behind the window as seen from the
// last image.
struct MirrorFrustum {
  MirrorSequence sequence = kNoMirrors;
  std::vector<int> mirrors;  // in travel order from the antenna
  std::vector<Vec3> images;  // of the antenna over the first 1, 2, .. of these mirrors
  Vec3 lit_normal;           // of the last mirror, unit, on the side that is lit
  double offset = 0.0;       // of its plane: lit_normal.dot(p) > offset is lit
  std::vector<Vec3> window;  // corners of the polygon on the last mirror through which the last image is seen
  std::vector<Vec3> rims;    // inward unit normals of the planes through the last image and an edge of the window

  const Vec3& image() const { return images.back(); }
  // Returns whether a ball of `radius` (m) about `point` reaches into the frustum. This is true for all that is lit and for
  // little else: rays find out whether mirrors have holes or something stands in the way.
  bool reaches(const Vec3& point, double radius) const;
  // Returns all points from which a ball of `radius` (m) reaches the frustum, as half-spaces.
  std::vector<HalfSpace> region(double radius) const;
};

struct FrustumSearch {
  int max_mirrors = kMaxLegMirrors;
  double slack = 0.0;  // m, by which windows are larger than what is lit
  size_t max_frusta = kMaxFrusta;
  // Windows that other surfaces hide are kept while there is room: what is not followed further is found sooner so.
  bool keeps_hidden = false;
};

struct MirrorFrusta {
  std::vector<MirrorFrustum> frusta;  // by number of mirrors and then by mirrors in travel order
  int64_t num_unfollowed = 0;         // sequences below max_mirrors whose further mirrors were not looked for
};

class FrustumFinder {
 public:
  // With `geometry`, sequences whose last mirror lies wholly behind other surfaces that cast shadows are left out. Both must
  // outlive this.
  explicit FrustumFinder(const std::vector<Mirror>& mirrors, const EmbreeScene* geometry = nullptr,
                         ShadowCasters casters = {});
  // Returns the frusta of an antenna over sequences of at most `search.max_mirrors` mirrors; sequences that light nothing
  // are left out. Raises Cancelled when the job is cancelled.
  MirrorFrusta find(const Vec3& antenna, const FrustumSearch& search, const Job* job = nullptr) const;
  // Appends those over `search.max_mirrors` mirrors to `out`, which holds all over fewer mirrors. Raises Cancelled.
  void lengthen(const Vec3& antenna, const FrustumSearch& search, MirrorFrusta& out, const Job* job = nullptr) const;

 private:
  void extend(const MirrorFrustum* frustum, const Vec3& source, const FrustumSearch& search,
              std::vector<MirrorFrustum>& out) const;
  bool reflect(const MirrorFrustum* frustum, const Vec3& source, int index, const FrustumSearch& search,
               MirrorFrustum& out) const;
  bool cut_window(const MirrorFrustum* frustum, const Vec3& source, const Mirror& mirror, double slack,
                  std::vector<Vec3>& window) const;
  void follow(size_t begin, size_t end, const FrustumSearch& search, const Job* job, MirrorFrusta& out) const;

  const std::vector<Mirror>& mirrors_;
  BoxHierarchy boxes_;  // of the mirrors
  std::unique_ptr<const FrustumShadows> shadows_;
};

}  // namespace echopath
