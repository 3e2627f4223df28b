#include "echopath/trace/mirror_beams.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/parallel.h"

namespace echopath {
namespace {

constexpr double kOnPlane = 1e-4;      // m: an antenna or image this near the plane has no image in it
constexpr double kFlatBox = 1e-4;      // m: mirrors may stray this far from their outlines
constexpr size_t kTogether = 512;      // beams that are followed side by side

std::vector<Eigen::AlignedBox3d> boxes_of(const std::vector<Mirror>& mirrors) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Mirror& mirror : mirrors) {
    Eigen::AlignedBox3d box;
    for (const Vec3& corner : mirror.outline) box.extend(corner);
    boxes.emplace_back(box.min().array() - kFlatBox, box.max().array() + kFlatBox);
  }
  return boxes;
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

std::vector<HalfSpace> Beam::region(double radius) const {
  std::vector<HalfSpace> region = {{lit_normal, offset - radius}};
  for (const Vec3& rim : rims) region.push_back({rim, rim.dot(image()) - radius});
  return region;
}

BeamFinder::BeamFinder(const std::vector<Mirror>& mirrors, const EmbreeScene* geometry)
    : mirrors_(mirrors), boxes_(boxes_of(mirrors)),
      shadows_(geometry ? std::make_unique<const BeamShadows>(*geometry, mirrors) : nullptr) {}

// What a mirror shows of the beam (null: of the antenna itself) whose source appears at `source`.
bool BeamFinder::reflect(const Beam* beam, const Vec3& source, int index, double slack, Beam& out) const {
  const Mirror& mirror = mirrors_[static_cast<size_t>(index)];
  const double side = mirror.signed_distance(source);
  if (std::abs(side) < kOnPlane) return false;
  std::vector<Vec3> window = mirror.outline;
  if (beam) {
    window = clipped(window, beam->lit_normal, beam->offset - slack);
    for (const Vec3& rim : beam->rims) {
      if (window.empty()) return false;
      window = clipped(window, rim, rim.dot(source) - slack);
    }
  }
  if (shadows_ && !window.empty()) {
    const BeamSource from{source, beam ? &beam->lit_normal : nullptr, beam ? beam->offset : 0.0};
    shadows_->shrink(from, mirror, window);
  }
  if (window.empty()) return false;
  out = beam ? *beam : Beam();
  out.window = std::move(window);
  out.mirrors.push_back(index);
  const bool is_long = out.mirrors.size() > kMaxLegMirrors;
  out.sequence = is_long ? kLongSequence : extended(out.sequence, index, mirrors_.size());
  out.images.push_back(mirror.image(source));
  out.lit_normal = side > 0 ? mirror.normal : Vec3(-mirror.normal);
  out.offset = out.lit_normal.dot(mirror.point);
  out.rims = rims_of(out.window, out.image());
  return true;
}

// Appends what all mirrors show of the beam.
void BeamFinder::extend(const Beam* beam, const Vec3& source, double slack, std::vector<Beam>& out) const {
  std::vector<int> lit;
  boxes_.find(beam ? beam->region(slack) : std::vector<HalfSpace>(), lit);
  Beam next;
  for (const int index : lit) {
    if (beam && beam->mirrors.back() == index) continue;
    if (reflect(beam, source, index, slack, next)) out.push_back(std::move(next));
  }
}

// Appends what follows on the beams [begin, end) of `out`, as far as there is room.
void BeamFinder::follow(size_t begin, size_t end, const BeamSearch& search, const Job* job, Beams& out) const {
  for (size_t first = begin; first < end; first += kTogether) {
    if (out.beams.size() >= search.max_beams) {
      out.num_unfollowed += static_cast<int64_t>(end - first);
      return;
    }
    std::vector<std::vector<Beam>> next(std::min(kTogether, end - first));
    Job own(job);
    parallel_for(std::ssize(next), [&](int64_t i) {
      const Beam& beam = out.beams[first + static_cast<size_t>(i)];
      extend(&beam, beam.image(), search.slack, next[static_cast<size_t>(i)]);
    }, &own);
    for (std::vector<Beam>& of_one : next) {
      std::move(of_one.begin(), of_one.end(), std::back_inserter(out.beams));
    }
  }
}

Beams BeamFinder::find(const Vec3& antenna, const BeamSearch& search, const Job* job) const {
  Beams out;
  if (search.max_mirrors > 0) extend(nullptr, antenna, search.slack, out.beams);
  size_t begin = 0;
  for (int count = 1; count < search.max_mirrors && begin < out.beams.size(); ++count) {
    const size_t end = out.beams.size();
    follow(begin, end, search, job, out);
    begin = end;
  }
  return out;
}

}  // namespace echopath
