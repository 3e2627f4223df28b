#include "echopath/trace/mirror_beams.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

constexpr double kSameCorner = 1e-6;  // m: the edge between corners this near has no direction
constexpr double kOnPlane = 1e-4;  // m: an antenna or image this near the plane has no image in it

// The part of a convex polygon where normal.dot(p) >= offset (Sutherland, Hodgman 1974); empty where it is a mere line.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& normal, double offset) {
  std::vector<Vec3> inside;
  const auto add = [&](const Vec3& corner) {
    if (inside.empty() || (corner - inside.back()).norm() > kSameCorner) inside.push_back(corner);
  };
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double before = normal.dot(from) - offset, behind = normal.dot(to) - offset;
    if (before >= 0) add(from);
    if ((before < 0) != (behind < 0)) add(from + before / (before - behind) * (to - from));
  }
  if (inside.size() > 1 && (inside.front() - inside.back()).norm() <= kSameCorner) inside.pop_back();
  return inside.size() < 3 ? std::vector<Vec3>() : inside;
}

std::vector<Vec3> rims_of(const std::vector<Vec3>& window, const Vec3& image) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& corner : window) centre += corner / static_cast<double>(window.size());
  std::vector<Vec3> rims;
  for (size_t i = 0; i < window.size(); ++i) {
    const Vec3 rim = (window[i] - image).cross(window[(i + 1) % window.size()] - image);
    rims.push_back((rim.dot(centre - image) < 0 ? -1.0 : 1.0) * rim.normalized());
  }
  return rims;
}

// What `mirror` shows of the beam (null: of the antenna itself) whose source appears at `source`.
bool reflect(const Beam* beam, const Vec3& source, const std::vector<Mirror>& mirrors, int index, Beam& out) {
  const Mirror& mirror = mirrors[static_cast<size_t>(index)];
  const double side = mirror.signed_distance(source);
  if (std::abs(side) < kOnPlane) return false;
  out = beam ? *beam : Beam();
  out.window = mirror.outline;
  if (beam) {
    out.window = clipped(out.window, beam->lit_normal, beam->offset);
    for (const Vec3& rim : beam->rims) out.window = clipped(out.window, rim, rim.dot(source));
  }
  if (out.window.empty()) return false;
  out.mirrors.push_back(index);
  const bool is_long = out.mirrors.size() > kMaxLegMirrors;
  out.sequence = is_long ? kLongSequence : extended(out.sequence, index, mirrors.size());
  out.images.push_back(mirror.image(source));
  out.lit_normal = side > 0 ? mirror.normal : Vec3(-mirror.normal);
  out.offset = out.lit_normal.dot(mirror.point);
  out.rims = rims_of(out.window, out.image());
  return true;
}

}  // namespace

bool Beam::reaches(const Vec3& point, double radius) const {
  if (lit_normal.dot(point) - offset < -radius) return false;
  const Vec3 line = point - image();
  for (const Vec3& rim : rims) {
    if (rim.dot(line) < -radius) return false;
  }
  return true;
}

std::vector<Beam> find_beams(const Vec3& antenna, const std::vector<Mirror>& mirrors, int max_mirrors, size_t max_beams) {
  std::vector<Beam> beams;
  Beam next;
  const auto extend = [&](const Beam* beam, const Vec3& source) {
    for (int index = 0; index < static_cast<int>(mirrors.size()) && beams.size() < max_beams; ++index) {
      if (beam && beam->mirrors.back() == index) continue;
      if (reflect(beam, source, mirrors, index, next)) beams.push_back(next);
    }
  };
  if (max_mirrors > 0) extend(nullptr, antenna);
  for (size_t i = 0; i < beams.size(); ++i) {
    if (static_cast<int>(beams[i].mirrors.size()) == max_mirrors) break;
    const Beam beam = beams[i];  // the list grows
    extend(&beam, beam.image());
  }
  return beams;
}

}  // namespace echopath
