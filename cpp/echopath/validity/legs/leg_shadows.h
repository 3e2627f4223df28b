#pragma once
// Finds the legs of a path that something stands in the way of, at one instant.
#include <bit>
#include <cstdint>

#include "echopath/replay/posed/path_geometry.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

// Holds what was found of the legs, in the order of the path's hits.
struct LegShadows {
  uint64_t blocked = 0;         // bit per hit: the leg that arrives there is blocked
  bool is_end_blocked = false;  // the leg from the last hit
  uint64_t off_mirror = 0;      // bit per hit: the image's point of reflection is not on its mirror

  void add(const LegShadows& other) {
    blocked |= other.blocked;
    is_end_blocked |= other.is_end_blocked;
    off_mirror |= other.off_mirror;
  }
};

// Tests the legs of one path against the triangles of `geometry`, whose origin is that of the posed hits. Legs over flagged
// mirrors are tested where the image puts them at this instant; a leg once found blocked is not tested again.
class LegTester {
 public:
  LegTester(const EmbreeScene& geometry, const LocalPath& path, const PosedHit* hits)
      : geometry_(geometry), path_(path), hits_(hits) {}

  // These test the legs from an antenna to the first hit that is no image, between such hits, and from the last of them to
  // an antenna.
  void test_start(const Vec3& antenna);
  void test_inner();
  void test_end(const Vec3& antenna);
  // Tests the legs of a path over images alone.
  void test_images(const Vec3& start, const Vec3& end);
  const LegShadows& shadows() const { return shadows_; }
  // Returns whether a wave was found, by one test, that meets all hits of the path in turn as images; then these are where.
  bool meets_all_images() const { return std::popcount(met_images_) == path_.count; }
  const Vec3& image_point(int hit) const { return image_points_[hit]; }
  const Hit& image_hit(int hit) const { return image_hits_[hit]; }

 private:
  struct End;
  static End facet_of(const PosedHit& hit);
  static End surface_of(const PosedHit& hit);
  void test_arrival(const End& from, int first, int last);
  void test(const End& from, int first, int last, const End& to);
  bool test_in_another_order(const End& from, int first, int last, const End& to);
  void test_legs(const End& from, int first, int last, const End& to);
  Vec3 lifted(const Vec3& point, const Vec3& normal, const Vec3& toward) const;
  Vec3 lifted_end(const End& end, const Vec3& point, const Vec3& toward) const;
  bool is_blocked(const Vec3& from, const Vec3& to, int image);
  bool is_blocked_before_sheet(const Vec3& from, const Vec3& to, int image);
  void meet_image(int image, const RayHit& met);
  bool is_known_blocked(int first, int last) const;
  void block(int leg);

  const EmbreeScene& geometry_;
  const LocalPath& path_;
  const PosedHit* hits_;
  LegShadows shadows_;
  Vec3 image_points_[64];
  Hit image_hits_[64];
  uint64_t met_images_ = 0;  // bit per hit: its point and hit as an image are known
};

}  // namespace echopath
