#include "echopath/validity/legs/leg_shadows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace echopath {
namespace {

constexpr double kSamePlace = 1e-6;         // m: bounces at an edge where two mirrors meet
constexpr double kOnMirrorAbsolute = 1e-3;  // m: how far before its place a leg may meet another mirror's edge
constexpr double kOnMirrorRelative = 1e-5;
constexpr double kOneImage = 2e-5;  // m: images as near to each other are one; .03 rad at 77 GHz
constexpr int kMostInTurn = 4;      // mirrors of a chain that are tried in all other orders
constexpr int kMostSwapped = 10;    // of a longer chain, of which neighbours are swapped
constexpr double kSquare = 1e-4;    // cosine

// Swaps neighbours in `order`, from a place on, in all ways in which each is swapped once at most and is square to the
// other, until `try_order` returns true; returns whether it did. The order is then that one, else as it was.
template <class Try>
bool swap_neighbours(std::span<const PosedHit> mirrors, std::vector<int>& order, size_t from, bool is_changed,
                     Try& try_order) {
  if (from + 1 >= order.size()) return is_changed && try_order();
  if (swap_neighbours(mirrors, order, from + 1, is_changed, try_order)) return true;
  if (std::abs(mirrors[from].normal.dot(mirrors[from + 1].normal)) > kSquare) return false;
  std::swap(order[from], order[from + 1]);
  if (swap_neighbours(mirrors, order, from + 2, true, try_order)) return true;
  std::swap(order[from], order[from + 1]);
  return false;
}

}  // namespace

// Describes an end of a chain of legs: an antenna, or a point of a surface with a normal and, where it is curved, the point
// of its facet.
struct LegTester::End {
  Vec3 point;
  Vec3 normal = Vec3::Zero();
  const Vec3* facet = nullptr;
  bool is_edge = false;  // the normal leads away from its faces, whatever is seen from there

  // Returns a point from where the surface does not hide `toward` itself: the curved point of a hollow facet lies behind it.
  const Vec3& seen_from(const Vec3& toward) const {
    return facet && normal.dot(toward - point) * normal.dot(point - *facet) < 0 ? *facet : point;
  }
};

// Returns the end at the flat triangle, where the trace found it.
LegTester::End LegTester::facet_of(const PosedHit& hit) {
  return hit.is_smooth ? End{hit.facet, hit.edge_u.cross(hit.edge_v).normalized()} : surface_of(hit);
}

// Returns the end on the curved surface, where the trace left it.
LegTester::End LegTester::surface_of(const PosedHit& hit) {
  return {hit.point, hit.normal, hit.is_smooth ? &hit.facet : nullptr, hit.is_edge};
}

void LegTester::block(int leg) {
  if (leg == path_.count) shadows_.is_end_blocked = true;
  else shadows_.blocked |= uint64_t{1} << leg;
}

bool LegTester::is_known_blocked(int first, int last) const {
  for (int leg = first; leg <= last; ++leg) {
    if (leg == path_.count ? shadows_.is_end_blocked : (shadows_.blocked | shadows_.off_mirror) >> leg & 1) return true;
  }
  return false;
}

// Lifts a point off the surface on the side of `toward`; an antenna stays.
Vec3 LegTester::lifted(const Vec3& point, const Vec3& normal, const Vec3& toward) const {
  return geometry_.lifted(point, Plane{point, normal}.normal_toward(toward));
}

// Lifts an end, at `point`, likewise; an edge is lifted off both of its faces.
Vec3 LegTester::lifted_end(const End& end, const Vec3& point, const Vec3& toward) const {
  return end.is_edge ? geometry_.lifted(point, end.normal) : lifted(point, end.normal, toward);
}

// `image` is the mirror on which `to` should lie, -1 for none. For a leg to a mirror, what it meets first is asked for.
bool LegTester::is_blocked(const Vec3& from, const Vec3& to, int image) {
  if (image < 0) return geometry_.occluded(from, to);
  if (geometry_.is_sheet(path_.hits[image].mesh_id)) return is_blocked_before_sheet(from, to, image);
  const double length = (to - from).norm();
  RayHit met;
  const EmbreeScene::Verdict verdict = geometry_.intersect(from, (to - from) / length, met);
  if (verdict == EmbreeScene::Verdict::kFalseHit) return false;
  const bool is_there = verdict == EmbreeScene::Verdict::kHit;
  const double slack = kOnMirrorAbsolute + kOnMirrorRelative * length;
  const bool is_on_plane = is_there && std::abs(hits_[image].height(met.position)) < slack;
  if ((is_on_plane && met.hit.mesh_id == path_.hits[image].mesh_id) ||
      (is_there && std::abs(met.distance - length) < slack)) {
    meet_image(image, met);
    return false;
  }
  if (is_there && met.distance < length) return true;
  shadows_.off_mirror |= uint64_t{1} << image;
  return false;
}

// Looks at the sheet from right before it, because others may lie on the way.
bool LegTester::is_blocked_before_sheet(const Vec3& from, const Vec3& to, int image) {
  const double length = (to - from).norm(), slack = kOnMirrorAbsolute + kOnMirrorRelative * length;
  const Vec3 direction = (to - from) / length, start = from + std::max(0.0, length - 2.0 * slack) * direction;
  if (geometry_.occluded(from, start)) return true;
  RayHit met;
  const bool is_there =
      geometry_.intersect_from_surface(start, direction, met, Sees::kSheets) == EmbreeScene::Verdict::kHit &&
      met.hit.mesh_id == path_.hits[image].mesh_id && met.distance < 4.0 * slack;
  if (is_there) meet_image(image, met);
  else shadows_.off_mirror |= uint64_t{1} << image;
  return false;
}

void LegTester::meet_image(int image, const RayHit& met) {
  image_hits_[image] = met.hit;
  met_images_ |= uint64_t{1} << image;
}

// Tests the legs from `from` over the mirrors [first, last) to `to`; they arrive at the hits first to last.
void LegTester::test(const End& from, int first, int last, const End& to) {
  if (is_known_blocked(first, last)) return;
  const auto missed =
      find_reflections(chain_of(hits_, first, last), from.point, to.point, image_points_ + first, kSamePlace);
  if (!missed) return test_legs(from, first, last, to);
  if (!test_in_another_order(from, first, last, to)) {
    shadows_.off_mirror |= uint64_t{1} << (static_cast<size_t>(first) + *missed);
  }
}

// Mirrors that are square to each other have one image in whatever order, so beyond the edge where they meet a wave of the
// same length takes them in another one. Tests the legs of that, and returns whether there is one.
bool LegTester::test_in_another_order(const End& from, int first, int last, const End& to) {
  if (last - first < 2 || last - first > kMostSwapped) return false;
  const Vec3 image = image_over(chain_of(hits_, first, last), from.point);
  std::vector<int> order(static_cast<size_t>(last - first));
  std::iota(order.begin(), order.end(), first);
  std::vector<PosedHit> posed(hits_, hits_ + path_.count);
  std::vector<LocalHit> local(path_.hits, path_.hits + path_.count);
  LocalPath path = path_;
  path.hits = local.data();
  const auto try_order = [&] {
    for (size_t k = 0; k < order.size(); ++k) {
      posed[static_cast<size_t>(first) + k] = hits_[order[k]];
      local[static_cast<size_t>(first) + k] = path_.hits[order[k]];
    }
    const std::span<const PosedHit> mirrors = chain_of(posed.data(), first, last);
    if ((image_over(mirrors, from.point) - image).norm() > kOneImage) return false;
    LegTester other(geometry_, path, posed.data());
    if (find_reflections(mirrors, from.point, to.point, other.image_points_ + first, kSamePlace)) return false;
    other.test_legs(from, first, last, to);
    if (other.shadows_.off_mirror != 0) return false;
    shadows_.add(other.shadows_);
    return true;
  };
  if (last - first > kMostInTurn) return swap_neighbours(chain_of(hits_, first, last), order, 0, false, try_order);
  while (std::ranges::next_permutation(order).found) {
    if (try_order()) return true;
  }
  return false;
}

// Tests legs whose points of reflection are known.
void LegTester::test_legs(const End& from, int first, int last, const End& to) {
  const std::span<const PosedHit> mirrors = chain_of(hits_, first, last);
  const Vec3* points = image_points_ + first;
  const auto lifted_at = [&](int mirror, const Vec3& toward) {
    return lifted_off_mirrors(mirrors, points, static_cast<size_t>(mirror - first), toward, kSamePlace, geometry_.lift());
  };
  for (int leg = first; leg <= last; ++leg) {
    const Vec3& start = leg > first ? image_points_[leg - 1] : from.seen_from(leg < last ? image_points_[leg] : to.point);
    const Vec3& end = leg < last ? image_points_[leg] : to.seen_from(start);
    if (leg > first && leg < last && (end - start).norm() <= kSamePlace) continue;
    const Vec3 off_start = leg > first ? lifted_at(leg - 1, end) : lifted_end(from, start, end);
    const Vec3 off_end = leg < last ? end : lifted_end(to, end, start);
    if (is_blocked(off_start, off_end, leg < last ? leg : -1)) return block(leg);
  }
}

// The trace found a smooth hit on its flat triangle, or looked back from the curved surface, so one of the two must be free.
void LegTester::test_arrival(const End& from, int first, int last) {
  const PosedHit& hit = hits_[last];
  const LegShadows before = shadows_;
  test(from, first, last, facet_of(hit));
  const bool is_worse = (shadows_.blocked & ~before.blocked) != 0 || (shadows_.off_mirror & ~before.off_mirror) != 0;
  if (!hit.is_smooth || !is_worse) return;
  shadows_ = before;
  test(from, first, last, surface_of(hit));
}

void LegTester::test_start(const Vec3& antenna) { test_arrival({antenna}, 0, path_.first_material); }

void LegTester::test_inner() {
  int previous = path_.first_material;
  for (int k = previous + 1; k <= path_.last_material; ++k) {
    if (path_.is_image(k)) continue;
    // The way over a flat face from edge to edge is free.
    const bool is_on_face = path_.is_edge(previous) && path_.is_edge(k);
    if (!is_on_face) test_arrival(surface_of(hits_[previous]), previous + 1, k);
    previous = k;
  }
}

void LegTester::test_end(const Vec3& antenna) {
  const int last = path_.last_material;
  test(surface_of(hits_[last]), last + 1, path_.count, {antenna});
}

void LegTester::test_images(const Vec3& start, const Vec3& end) { test({start}, 0, path_.count, {end}); }

}  // namespace echopath
