#include "echopath/scene/mesh/triangle_contacts.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "echopath/base/box_tree.h"
#include "echopath/base/geometry.h"

namespace echopath {
namespace {

constexpr uint32_t kSidesOfLeaf = 4;

// Returns whether a point of the box may lie within a distance of a segment, at times too often.
bool may_lie_near(const Box& box, const Vec3& from, const Vec3& to, double distance) {
  Box around(from.cwiseMin(to), from.cwiseMax(to));
  around.min().array() -= distance;
  around.max().array() += distance;
  return around.intersects(box) && distance_to_segment(box.center(), from, to) <= 0.5 * box.diagonal().norm() + distance;
}

}  // namespace

TriangleContacts::TriangleContacts(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                   double tolerance)
    : vertices_(vertices), triangles_(triangles), neighbours_(edge_neighbours(vertices, triangles)) {
  compare_open_sides(tolerance);
}

void TriangleContacts::compare_open_sides(double tolerance) {
  std::vector<Side> open;
  for (uint32_t t = 0; t < triangles_.size(); ++t) {
    for (uint32_t side = 0; side < 3; ++side) {
      if (neighbours_[t][side] == kNoTriangle) open.push_back({t, side});
    }
  }
  const auto box_of = [&](uint32_t i) {
    const Vec3 &from = corner(open[i], 0), &to = corner(open[i], 1);
    return Box(from.cwiseMin(to), from.cwiseMax(to));
  };
  const BoxTree tree(static_cast<uint32_t>(open.size()), box_of, kSidesOfLeaf);
  for (const Side& side : open) {
    const auto is_near = [&](const Box& box) { return may_lie_near(box, corner(side, 0), corner(side, 1), tolerance); };
    tree.for_each(is_near, [&](uint32_t index) {
      if (open[index].triangle != side.triangle) add_contact(side, open[index], tolerance);
    });
  }
  const auto key = [](const Contact& contact) {
    return std::tie(contact.triangle, contact.side, contact.begin, contact.other);
  };
  std::ranges::sort(contacts_, {}, key);
}

void TriangleContacts::add_contact(const Side& side, const Side& other, double tolerance) {
  const Vec3 from = corner(side, 0), line = corner(side, 1) - from;
  const double length = line.norm();
  const Vec3 along = line / length;
  Vec3 low = corner(other, 0), high = corner(other, 1);
  if (along.dot(high - low) < 0.0) std::swap(low, high);
  const double first = along.dot(low - from), last = along.dot(high - from);
  const double begin = std::max(first, 0.0), end = std::min(last, length);
  if (!(end - begin > tolerance)) return;
  for (const double at : {begin, end}) {
    const Vec3 there = low + (at - first) / (last - first) * (high - low);
    if ((there - from - at * along).norm() > tolerance) return;
  }
  // Small triangles tell a plane badly: the far corner of one of the two lies in the plane of the other.
  const Vec3 own = across(side, corner(side, 2)), others = across(side, corner(other, 2));
  const double turned = along.dot(own.cross(others));  // m^2: of a far corner over the plane, times the other's distance
  if (std::abs(turned) > tolerance * std::max(own.norm(), others.norm())) return;
  const bool is_beyond = own.dot(others) < 0.0;
  contacts_.push_back({side.triangle, side.side, other.triangle, begin, end, is_beyond});
}

// Returns the way from the line of a side straight to a point, m.
Vec3 TriangleContacts::across(const Side& side, const Vec3& point) const {
  const Vec3 along = (corner(side, 1) - corner(side, 0)).normalized(), way = point - corner(side, 0);
  return way - along.dot(way) * along;
}

// Returns whether a triangle that shares the ends of a side lies on the other side of it, as none does that is listed twice.
bool TriangleContacts::goes_on_beyond(const Side& side, uint32_t next) const {
  const auto& [a, b, c] = triangles_[next];
  const Vec3 middle = (vertices_[a] + vertices_[b] + vertices_[c]) / 3.0;
  return across(side, corner(side, 2)).dot(across(side, middle)) < 0.0;
}

std::span<const TriangleContacts::Contact> TriangleContacts::contacts_of(uint32_t triangle) const {
  const auto [begin, end] = std::ranges::equal_range(contacts_, triangle, {}, &Contact::triangle);
  return {begin, end};
}

std::vector<uint32_t> TriangleContacts::touching(uint32_t triangle) const {
  std::vector<uint32_t> found;
  for (const uint32_t next : neighbours_[triangle]) {
    if (next != kNoTriangle) found.push_back(next);
  }
  for (const Contact& contact : contacts_of(triangle)) found.push_back(contact.other);
  return found;
}

double TriangleContacts::open_length(uint32_t triangle, const std::function<bool(uint32_t)>& is_other) const {
  double length = 0.0;
  for (uint32_t side = 0; side < 3; ++side) {
    const uint32_t next = neighbours_[triangle][side];
    const Side own{triangle, side};
    const bool goes_on = next != kNoTriangle && is_other(next) && goes_on_beyond(own, next);
    if (!goes_on) length += (corner(own, 1) - corner(own, 0)).norm();
  }
  uint32_t side = 0;
  double covered = 0.0;  // m, as far as the side is known to go on
  for (const Contact& contact : contacts_of(triangle)) {
    if (std::exchange(side, contact.side) != contact.side) covered = 0.0;
    if (!contact.is_beyond || !is_other(contact.other) || contact.end <= covered) continue;
    length -= contact.end - std::max(contact.begin, covered);
    covered = contact.end;
  }
  return length;
}

}  // namespace echopath
