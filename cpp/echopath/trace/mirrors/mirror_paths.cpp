#include "echopath/trace/mirrors/mirror_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "echopath/base/parallel.h"
#include "echopath/trace/mirrors/mirror_frusta.h"

namespace echopath {
namespace {

constexpr double kAtEdge = 1e-4;  // m: bounces this near to each other are at a common edge
// A path through an edge belongs to the sequences of mirrors on both sides of it: those of a receiver a little beside the
// true one, and of one as far on the other side. No scene is likely to be built along the direction of the shift.
constexpr double kAside = 1e-5;  // m
const Vec3 kAsideDirection = Vec3(0.6180339887, 0.7320508076, -0.2915026221).normalized();
constexpr size_t kFrustaPerBlock = 64;

// Tries sequences one by one.
class ImageMethod {
 public:
  ImageMethod(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const SbrSettings& settings, PathBlock& block)
      : geometry_(geometry), mirrors_(mirrors), settings_(settings), block_(block) {}

  void try_sequence(std::vector<int> sequence) {
    sequence_ = std::move(sequence);
    try_sequence();
  }

 private:
  const Mirror& mirror(size_t k) const { return mirrors_[static_cast<size_t>(sequence_[k])]; }

  void try_sequence() {
    int num_found = 0;
    for (const double side : {1.0, -1.0}) num_found += follow(settings_.receiver + side * kAside * kAsideDirection) ? 1 : 0;
    if (num_found == 0) return;
    const std::complex<double> weight = (settings_.is_polarized ? 1.0 : field()) * (0.5 * num_found);
    if (std::abs(weight) == 0) return;
    block_.add(hits_.data(), static_cast<int>(hits_.size()), 0, std::complex<float>(weight), kNoStratum);
    if (settings_.is_polarized) block_.set_jones(jones_matrix());
    block_.statistics.num_hits += static_cast<int64_t>(hits_.size());
  }

  // Follows the sequence to a receiver; sets hits_ and returns true where the path gets through.
  bool follow(const Vec3& receiver) {
    if (!find_points(receiver)) return false;
    std::vector<Hit> hits;
    for (size_t k = 0; k < points_.size(); ++k) {
      const std::optional<Hit> hit = mirror(k).mesh.locate(points_[k]);
      if (!hit) return false;
      hits.push_back(*hit);
    }
    if (!sees_all(receiver)) return false;
    hits_ = std::move(hits);
    return true;
  }

  // Finds the specular points from the receiver backwards through the images of the transmitter.
  bool find_points(const Vec3& receiver) {
    const size_t n = sequence_.size();
    std::vector<Vec3> images(n + 1);
    images[0] = settings_.transmitter;
    for (size_t k = 0; k < n; ++k) images[k + 1] = mirror(k).image(images[k]);
    points_.assign(n, Vec3::Zero());
    Vec3 target = receiver;
    for (size_t k = n; k-- > 0;) {
      const double behind = mirror(k).height(images[k + 1]), before = mirror(k).height(target);
      if (behind * before >= 0) return false;
      points_[k] = target + before / (before - behind) * (images[k + 1] - target);
      target = points_[k];
    }
    return true;
  }

  // Lifts the point off all the planes that meet in it, toward the side of the target.
  Vec3 lifted_toward(size_t k, const Vec3& target) const {
    Vec3 point = points_[k];
    for (size_t other = 0; other < points_.size(); ++other) {
      if ((points_[other] - points_[k]).norm() > kAtEdge) continue;
      const Mirror& plane = mirror(other);
      point = geometry_.lifted(point, plane.height(target) >= 0 ? plane.normal : Vec3(-plane.normal));
    }
    return point;
  }

  bool sees_all(const Vec3& receiver) {
    const size_t n = points_.size();
    for (size_t k = 0; k <= n; ++k) {
      const Vec3 from = k == 0 ? settings_.transmitter : lifted_toward(k - 1, k == n ? receiver : points_[k]);
      const Vec3 to = k == n ? receiver : lifted_toward(k, k == 0 ? settings_.transmitter : points_[k - 1]);
      if (k > 0 && k < n && (points_[k] - points_[k - 1]).norm() < kAtEdge) continue;
      ++block_.statistics.num_queries;
      if (geometry_.occluded(from, to)) return false;
    }
    return true;
  }

  // Returns the departure of the path to the true receiver.
  Vec3 departure() const {
    Vec3 image = settings_.receiver;
    for (size_t k = points_.size(); k-- > 0;) image = mirror(k).image(image);
    return (image - settings_.transmitter).normalized();
  }

  JonesMatrix jones_matrix() const {
    Vec3 direction = departure();
    FieldPair fields = launched_fields(direction);
    for (size_t k = 0; k < points_.size(); ++k) {
      const Vec3 normal = direction.dot(mirror(k).normal) < 0 ? mirror(k).normal : Vec3(-mirror(k).normal);
      const double cos_incidence = -direction.dot(normal);
      const SurfaceModel model(*mirror(k).material, settings_.frequency);
      const ModeCoefficients modes = model.modes(cos_incidence);
      const double coherent = model.respond(cos_incidence, PolarizationMode::kTe).coherent;
      for (FieldVector& field : fields) field = coherent * reflected_field(field, direction, normal, modes);
      direction = mirror(k).mirrored(direction);
    }
    return arriving_components(fields, direction);
  }

  std::complex<double> field() const {
    std::complex<double> product = 1.0;
    Vec3 direction = departure();
    for (size_t k = 0; k < points_.size(); ++k) {
      const Vec3& normal = mirror(k).normal;
      const PolarizationMode mode = polarization_mode(settings_.polarization, direction, normal);
      const SurfaceResponse response =
          respond(*mirror(k).material, settings_.frequency, std::abs(direction.dot(normal)), mode);
      product *= response.gamma * response.coherent *
                 mirror_sign(*mirror(k).material, mode, settings_.polarization, direction, normal);
      direction = mirror(k).mirrored(direction);
    }
    return product;
  }

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  const SbrSettings& settings_;
  PathBlock& block_;
  std::vector<int> sequence_;
  std::vector<Vec3> points_;
  std::vector<Hit> hits_;
};

// A range holds the frusta of one antenna with the same number of mirrors.
using FrustumRange = std::pair<const MirrorFrustum*, const MirrorFrustum*>;

FrustumRange with_mirrors(const std::vector<MirrorFrustum>& frusta, size_t count) {
  const auto is_shorter = [](const MirrorFrustum& frustum, size_t wanted) { return frustum.mirrors.size() < wanted; };
  const auto begin = std::lower_bound(frusta.begin(), frusta.end(), count, is_shorter);
  const auto end = std::lower_bound(begin, frusta.end(), count + 1, is_shorter);
  return {frusta.data() + (begin - frusta.begin()), frusta.data() + (end - frusta.begin())};
}

// Finds pairs of frusta of transmitter and receiver, each of which shows the other's antenna, or its image.
class HalfwayMeeting {
 public:
  HalfwayMeeting(FrustumRange transmit, FrustumRange receive)
      : transmit_(transmit), receive_(receive), images_(boxes_of_images(receive)) {}

  // Calls body(sequence) for every sequence that begins with the transmit frustum, in the order of the mirrors.
  template <class Body>
  void sequences(const MirrorFrustum& frustum, const Body& body) const {
    if (receive_.first == receive_.second) return;
    std::vector<int> found;
    images_.find(frustum.region(kAtEdge), found);
    std::vector<std::vector<int>> sequences;
    for (const int index : found) {
      const MirrorFrustum& other = receive_.first[index];
      if (other.mirrors.back() == frustum.mirrors.back() || !shows(other, frustum.image())) continue;
      std::vector<int>& sequence = sequences.emplace_back(frustum.mirrors);
      sequence.insert(sequence.end(), other.mirrors.rbegin(), other.mirrors.rend());
    }
    std::sort(sequences.begin(), sequences.end());
    for (std::vector<int>& sequence : sequences) body(std::move(sequence));
  }

  size_t size() const { return static_cast<size_t>(transmit_.second - transmit_.first); }
  const MirrorFrustum& operator[](size_t i) const { return transmit_.first[i]; }

 private:
  static std::vector<Eigen::AlignedBox3d> boxes_of_images(FrustumRange frusta) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const MirrorFrustum* one = frusta.first; one != frusta.second; ++one)
      boxes.emplace_back(one->image(), one->image());
    return boxes;
  }

  // Returns whether a frustum reaches a point that may be far behind it; its window may miss the point by kAtEdge.
  static bool shows(const MirrorFrustum& frustum, const Vec3& point) {
    const double before = frustum.offset - frustum.lit_normal.dot(frustum.image());
    const double behind = frustum.lit_normal.dot(point) - frustum.offset;
    return behind > -kAtEdge && frustum.reaches(point, kAtEdge * std::max(1.0, (before + behind) / before));
  }

  FrustumRange transmit_, receive_;
  BoxHierarchy images_;  // of the receiver
};

class MirrorPathSearch {
 public:
  MirrorPathSearch(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const SbrSettings& settings,
                   const Job* job)
      : geometry_(geometry), mirrors_(mirrors), settings_(settings), job_(job) {
    const FrustumFinder finder(mirrors, &geometry);
    const int half = settings.max_bounces / 2;
    transmit_ = finder.find(settings.transmitter, {.max_mirrors = settings.max_bounces - half, .slack = kAtEdge}, job);
    receive_ = finder.find(settings.receiver, {.max_mirrors = half, .slack = kAtEdge}, job);
  }

  std::vector<PathBlock> run() {
    std::vector<PathBlock> blocks(1);
    blocks[0].statistics.num_unfollowed_beams = transmit_.num_unfollowed + receive_.num_unfollowed;
    add_single(blocks[0]);
    for (int count = 2; count <= settings_.max_bounces; ++count) add_longer(static_cast<size_t>(count), blocks);
    return blocks;
  }

 private:
  // Adds the paths over one mirror, whose frusta show the receiver itself.
  void add_single(PathBlock& block) const {
    ImageMethod images(geometry_, mirrors_, settings_, block);
    const auto [begin, end] = with_mirrors(transmit_.frusta, 1);
    for (const MirrorFrustum* frustum = begin; frustum != end; ++frustum) {
      if (frustum->reaches(settings_.receiver, kAtEdge)) images.try_sequence(frustum->mirrors);
    }
  }

  void add_longer(size_t count, std::vector<PathBlock>& blocks) const {
    const HalfwayMeeting meeting(with_mirrors(transmit_.frusta, count - count / 2),
                                 with_mirrors(receive_.frusta, count / 2));
    const size_t first = blocks.size();
    blocks.resize(first + (meeting.size() + kFrustaPerBlock - 1) / kFrustaPerBlock);
    Job own(job_);
    parallel_for(std::ssize(blocks) - static_cast<int64_t>(first), [&](int64_t k) {
      const size_t begin = static_cast<size_t>(k) * kFrustaPerBlock, end = std::min(meeting.size(), begin + kFrustaPerBlock);
      ImageMethod images(geometry_, mirrors_, settings_, blocks[first + static_cast<size_t>(k)]);
      for (size_t i = begin; i < end; ++i) {
        meeting.sequences(meeting[i], [&](std::vector<int> sequence) { images.try_sequence(std::move(sequence)); });
      }
    }, &own);
  }

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  const SbrSettings& settings_;
  const Job* job_;
  MirrorFrusta transmit_, receive_;
};

}  // namespace

std::vector<PathBlock> find_mirror_paths(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                                         const SbrSettings& settings, const Job* job) {
  return MirrorPathSearch(geometry, mirrors, settings, job).run();
}

}  // namespace echopath
