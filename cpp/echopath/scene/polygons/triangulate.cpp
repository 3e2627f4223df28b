#include "echopath/scene/polygons/triangulate.h"

#include <functional>
#include <queue>

#include "echopath/scene/polygons/corner_tree.h"

namespace echopath {
namespace {

// How often each corner may be looked at. A simple polygon needs three; more can only help one that touches itself.
constexpr size_t kLooksPerCorner = 8;

// Returns twice the vector area (Newell), which is normal to the mean plane.
Vec3 polygon_normal(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners) {
  Vec3 normal = Vec3::Zero();
  const Vec3& origin = vertices[corners[0]];
  for (size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += (vertices[corners[i]] - origin).cross(vertices[corners[i + 1]] - origin);
  }
  return normal;
}

bool is_convex(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners, const Vec3& normal) {
  const size_t n = corners.size();
  for (size_t i = 0; i < n; ++i) {
    const Vec3 &a = vertices[corners[i]], &b = vertices[corners[(i + 1) % n]], &c = vertices[corners[(i + 2) % n]];
    if (turn(a, b, c, normal) < 0.0) return false;
  }
  return true;
}

void append_fan(const std::vector<uint32_t>& places, std::vector<Triangle>& triangles) {
  for (size_t i = 1; i + 1 < places.size(); ++i) triangles.push_back({places[0], places[i], places[i + 1]});
}

// Cuts ears off a polygon. Whether a corner has an ear changes only where a neighbour was cut off, so that each corner is
// looked at when it gets a new neighbour, the first ones first.
class EarCutter {
 public:
  EarCutter(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners, const Vec3& normal)
      : vertices_(vertices), corners_(corners), normal_(normal), tree_(vertices, corners), num_left_(corners.size()),
        before_(corners.size()), after_(corners.size()), is_left_(corners.size(), 1), waits_(corners.size(), 0),
        looks_left_(kLooksPerCorner * corners.size()) {
    const auto n = static_cast<uint32_t>(corners.size());
    for (uint32_t place = 0; place < n; ++place) {
      before_[place] = (place + n - 1) % n;
      after_[place] = (place + 1) % n;
    }
  }

  // Appends the ears to `triangles`; returns the places that are left, three or those of a polygon without ears.
  std::vector<uint32_t> cut(std::vector<Triangle>& triangles) {
    for (size_t num_before = 0; num_before != num_left_ && num_left_ > 3 && looks_left_ > 0;) {
      num_before = num_left_;
      look_at_all();
      cut_waiting(triangles);
    }
    std::vector<uint32_t> rest;
    for (uint32_t place = 0; place < corners_.size(); ++place) {
      if (is_left_[place]) rest.push_back(place);
    }
    return rest;
  }

 private:
  void look_at_all() {
    for (uint32_t place = 0; place < corners_.size(); ++place) {
      if (is_left_[place]) look_at(place);
    }
  }

  void look_at(uint32_t place) {
    if (!waits_[place]) waiting_.push(place);
    waits_[place] = 1;
  }

  void cut_waiting(std::vector<Triangle>& triangles) {
    for (; !waiting_.empty() && num_left_ > 3 && looks_left_ > 0; --looks_left_) {
      const uint32_t place = waiting_.top();
      waiting_.pop();
      waits_[place] = 0;
      if (!is_left_[place] || !has_ear(place)) continue;
      triangles.push_back({before_[place], place, after_[place]});
      cut_off(place);
    }
  }

  Ear ear_at(uint32_t place) const {
    const uint32_t before = corners_[before_[place]], here = corners_[place], after = corners_[after_[place]];
    return {{vertices_[before], vertices_[here], vertices_[after]}, {before, here, after}, normal_};
  }

  // Returns whether the corner can be cut off: it turns inwards and no other corner lies in its triangle.
  bool has_ear(uint32_t place) const {
    const Ear ear = ear_at(place);
    return turn(ear.points[0], ear.points[1], ear.points[2], normal_) > 0.0 && !tree_.has_corner_in(ear);
  }

  void cut_off(uint32_t place) {
    const uint32_t before = before_[place], after = after_[place];
    after_[before] = after;
    before_[after] = before;
    is_left_[place] = 0;
    tree_.remove(place);
    --num_left_;
    look_at(before);
    look_at(after);
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<uint32_t>& corners_;
  Vec3 normal_;
  CornerTree tree_;
  size_t num_left_;
  std::vector<uint32_t> before_, after_;  // [n] places of the neighbours
  std::vector<uint8_t> is_left_, waits_;  // [n]
  size_t looks_left_;
  std::priority_queue<uint32_t, std::vector<uint32_t>, std::greater<>> waiting_;  // places, the first on top
};

}  // namespace

std::vector<Triangle> triangulate(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& corners) {
  std::vector<Triangle> triangles;
  triangles.reserve(corners.size() - 2);
  const Vec3 normal = polygon_normal(vertices, corners);
  if (corners.size() == 3 || is_convex(vertices, corners, normal)) {
    for (uint32_t place = 1; place + 1 < corners.size(); ++place) triangles.push_back({0, place, place + 1});
  } else {
    append_fan(EarCutter(vertices, corners, normal).cut(triangles), triangles);
  }
  return triangles;
}

}  // namespace echopath
