#pragma once
// Finds the point of a mesh that is nearest to a point. The boxes about runs of triangles tell which of these need not be
// looked at, and they are most of them.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "echopath/scene/runs/triangle_runs.h"

namespace echopath {

// Returns the point of a triangle, given by its corners, that is nearest to a point, m.
Vec3 nearest_of_triangle(const std::array<Vec3, 3>& corners, const Vec3& point);

// Says where the boxes of a mesh lie, which may be those of the mesh at rest, among the triangles that are looked at.
struct FrameOfBoxes {
  Mat3 to_boxes = Mat3::Identity();      // takes lines among the triangles to those among the boxes
  Vec3 place = Vec3::Zero();             // m, of the origin of the boxes among the triangles
  double shortest = 1.0, longest = 1.0;  // lengths among the triangles of what is 1 m long among the boxes

  // Returns the frame of boxes of which the matrix takes lines to those among the triangles.
  static FrameOfBoxes mapped(const Mat3& linear, const Vec3& place);
};

// Looks for the nearest point run by run. It does not look at a run that is nowhere nearer than the farthest corner of
// another one, nor at one that is nowhere nearer than what was found in those that begin before it.
class NearestOfRuns {
 public:
  // The boxes, one for each run of the triangles, must outlive it.
  NearestOfRuns(const std::vector<Box>& boxes, size_t num_triangles, const FrameOfBoxes& frame = {})
      : boxes_(boxes), num_triangles_(static_cast<uint32_t>(num_triangles)), frame_(frame) {}

  // Returns the nearest point if it is less than `limit` (m) from `point`. corners_of(i) are the corners of triangle i.
  template <class CornersOf>
  std::optional<Vec3> within(double limit, const Vec3& point, const CornersOf& corners_of) const {
    std::optional<Vec3> nearest;
    double least = limit;
    for (const auto& [begin, run] : runs_within(limit, point)) {
      if (begin >= least) break;
      const uint32_t end = std::min((run + 1) * kRunLength, num_triangles_);
      for (uint32_t i = run * kRunLength; i < end; ++i) {
        const std::array<Vec3, 3> corners = corners_of(i);
        if (!is_box_nearer(corners, point, least)) continue;
        const Vec3 found = nearest_of_triangle(corners, point);
        const double distance = (found - point).norm();
        if (distance < least) nearest = found, least = distance;
      }
    }
    return nearest;
  }

 private:
  // Returns the runs that may be nearer than `limit`, and how far away they begin at least, m, in this order.
  std::vector<std::pair<double, uint32_t>> runs_within(double limit, const Vec3& point) const;
  static bool is_box_nearer(const std::array<Vec3, 3>& corners, const Vec3& point, double least);

  const std::vector<Box>& boxes_;
  uint32_t num_triangles_;
  FrameOfBoxes frame_;
};

}  // namespace echopath
