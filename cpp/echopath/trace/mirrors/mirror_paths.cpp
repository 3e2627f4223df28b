#include "echopath/trace/mirrors/mirror_paths.h"

#include <algorithm>
#include <optional>

#include "echopath/base/threads/parallel.h"
#include "echopath/trace/frusta/mirror_frusta.h"
#include "echopath/trace/mirrors/image_method.h"

namespace echopath {
namespace {

constexpr int64_t kFrustaPerBlock = 64;

// Tries sequences one by one.
class SequenceTrier {
 public:
  SequenceTrier(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors, const SbrSettings& settings,
                PathBlock& block)
      : images_(geometry, mirrors, locator_, settings), block_(block) {}
  ~SequenceTrier() { block_.statistics.num_queries += images_.num_queries(); }

  void try_sequence(const std::vector<int>& sequence) {
    if (const std::optional<ImagePath> path = images_.path_over(sequence)) add_path(*path, block_);
  }

 private:
  MeshLocator locator_;
  ImageMethod images_;
  PathBlock& block_;
};

// A range holds the frusta of one antenna with the same number of mirrors.
using FrustumRange = std::pair<const MirrorFrustum*, const MirrorFrustum*>;

FrustumRange with_mirrors(const std::vector<MirrorFrustum>& frusta, size_t count) {
  const auto num_mirrors = [](const MirrorFrustum& frustum) { return frustum.mirrors.size(); };
  return {std::to_address(std::ranges::lower_bound(frusta, count, {}, num_mirrors)),
          std::to_address(std::ranges::upper_bound(frusta, count, {}, num_mirrors))};
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
    std::ranges::sort(sequences);
    for (std::vector<int>& sequence : sequences) body(std::move(sequence));
  }

  size_t size() const { return static_cast<size_t>(transmit_.second - transmit_.first); }
  const MirrorFrustum& operator[](size_t i) const { return transmit_.first[i]; }

 private:
  static std::vector<Box> boxes_of_images(FrustumRange frusta) {
    std::vector<Box> boxes;
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
                   const AntennaFrusta& frusta, const Job* job)
      : geometry_(geometry), mirrors_(mirrors), settings_(settings), frusta_(frusta), job_(job) {}

  std::vector<PathBlock> run() {
    std::vector<PathBlock> blocks(1);
    add_single(blocks[0]);
    for (int count = 2; count <= settings_.max_bounces; ++count) add_longer(static_cast<size_t>(count), blocks);
    return blocks;
  }

 private:
  // Adds the paths over one mirror, whose frusta show the receiver itself.
  void add_single(PathBlock& block) const {
    SequenceTrier images(geometry_, mirrors_, settings_, block);
    const auto [begin, end] = with_mirrors(frusta_.transmitter.frusta, 1);
    for (const MirrorFrustum* frustum = begin; frustum != end; ++frustum) {
      if (frustum->reaches(settings_.receiver, kAtEdge)) images.try_sequence(frustum->mirrors);
    }
  }

  void add_longer(size_t count, std::vector<PathBlock>& blocks) const {
    const bool is_of_receiver = frusta_.receiver_is_longer && static_cast<int>(count) == settings_.max_bounces;
    const size_t of_transmitter = is_of_receiver ? count / 2 : count - count / 2;
    const HalfwayMeeting meeting(with_mirrors(frusta_.transmitter.frusta, of_transmitter),
                                 with_mirrors(frusta_.receiver.frusta, count - of_transmitter));
    const size_t first = blocks.size();
    const auto num_frusta = std::ssize(meeting);
    blocks.resize(first + num_chunks(num_frusta, kFrustaPerBlock));
    Job own(job_);
    parallel_for_chunks(num_frusta, kFrustaPerBlock, [&](int64_t begin, int64_t end) {
      SequenceTrier images(geometry_, mirrors_, settings_, blocks[first + begin / kFrustaPerBlock]);
      for (int64_t i = begin; i < end; ++i) {
        meeting.sequences(meeting[i], [&](std::vector<int> sequence) { images.try_sequence(sequence); });
      }
    }, &own);
  }

  const EmbreeScene& geometry_;
  const std::vector<Mirror>& mirrors_;
  const SbrSettings& settings_;
  const AntennaFrusta& frusta_;
  const Job* job_;
};

}  // namespace

std::vector<PathBlock> find_mirror_paths(const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                                         const SbrSettings& settings, const AntennaFrusta& frusta, const Job* job) {
  return MirrorPathSearch(geometry, mirrors, settings, frusta, job).run();
}

}  // namespace echopath
