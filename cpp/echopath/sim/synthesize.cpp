#include "echopath/sim/synthesize.h"

#include <algorithm>
#include <span>
#include <utility>

#include "echopath/base/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kBlocksInFlight = 16;        // fixed: results must not depend on the number of threads
constexpr int64_t kEchoesInFlight = 1 << 18;   // node values per channel set: paths x channels
constexpr int64_t kNodesOfAPath = 32;          // that these echoes may have each before there are fewer of them
constexpr int64_t kLargestBlock = 8192;
constexpr int64_t kSmallestBlock = 64;

int64_t block_size(int64_t num_channels, int64_t num_nodes) {
  const int64_t values = num_channels * std::max<int64_t>(1, num_nodes / kNodesOfAPath);
  return std::clamp(kEchoesInFlight / (kBlocksInFlight * values), kSmallestBlock, kLargestBlock);
}

using ByChannel = std::vector<Echoes>;

struct Stream {
  const Replayer& replayer;
  const std::vector<uint32_t>* group;  // null: all in group 0
  Synthesizer& synthesizer;
  Job* job;

  void add_still(const std::vector<int64_t>& paths) {
    run(paths, block_size(replayer.num_channels(), 1), [&](auto part, auto&) { return replayer.still(part); });
  }

  // Each path at the order that its meshes need; where that was not enough, at the next.
  void add_moving(const std::vector<int64_t>& paths) {
    const int num_levels = replayer.num_levels();
    std::vector<std::vector<int64_t>> by_level(static_cast<size_t>(num_levels) + 2);
    for (const int64_t path : paths) by_level[static_cast<size_t>(replayer.first_level(path))].push_back(path);
    const int64_t size = block_size(replayer.num_channels(), kNodesOfAPath);
    for (int level = 1; level <= num_levels; ++level) {
      const auto at = static_cast<size_t>(level);
      const std::vector<int64_t> failed = run(by_level[at], size, [&](auto part, std::vector<int64_t>& left) {
        return replayer.interpolated(part, level, left);
      });
      by_level[at + 1].insert(by_level[at + 1].end(), failed.begin(), failed.end());
    }
    run(by_level.back(), block_size(replayer.num_channels(), replayer.num_exact_nodes()),
        [&](auto part, auto&) { return replayer.exact(part); });
  }

 private:
  // Blocks are replayed in parallel, a fixed number at a time, and added in their order. Returns the paths that `replay` left.
  template <typename Replay>
  std::vector<int64_t> run(const std::vector<int64_t>& paths, int64_t size, const Replay& replay) {
    std::vector<int64_t> all_left;
    const auto num_paths = static_cast<int64_t>(paths.size());
    for (int64_t begin = 0; begin < num_paths; begin += size * kBlocksInFlight) {
      const int64_t num_blocks = std::min(kBlocksInFlight, (num_paths - begin + size - 1) / size);
      const auto part = [&](int64_t i) {
        const int64_t first = begin + i * size;
        return std::span<const int64_t>(paths.data() + first, static_cast<size_t>(std::min(size, num_paths - first)));
      };
      std::vector<ByChannel> blocks(static_cast<size_t>(num_blocks));
      std::vector<std::vector<int64_t>> left(blocks.size());
      parallel_for(num_blocks, [&](int64_t i) {
        if (job) job->throw_if_cancelled();
        blocks[static_cast<size_t>(i)] = replay(part(i), left[static_cast<size_t>(i)]);
      });
      for (int64_t i = 0; i < num_blocks; ++i) {
        add(blocks[static_cast<size_t>(i)], part(i));
        all_left.insert(all_left.end(), left[static_cast<size_t>(i)].begin(), left[static_cast<size_t>(i)].end());
      }
    }
    return all_left;
  }

  void add(ByChannel& channels, std::span<const int64_t> paths) {
    for (size_t channel = 0; channel < channels.size(); ++channel) {
      if (job) job->throw_if_cancelled();
      if (group) {
        for (const int64_t path : paths) channels[channel].group.push_back((*group)[static_cast<size_t>(path)]);
      }
      synthesizer.add(static_cast<int>(channel), channels[channel], job);
    }
  }
};

// Indices of the paths on which nothing moves, and of the others.
std::pair<std::vector<int64_t>, std::vector<int64_t>> split_by_motion(const Replayer& replayer, int64_t num_paths, Job* job) {
  std::pair<std::vector<int64_t>, std::vector<int64_t>> split;
  auto& [still, moving] = split;
  const auto is_still = [&](int64_t path) {
    if (job && path % kLargestBlock == 0) job->throw_if_cancelled();
    return replayer.is_static(path);
  };
  int64_t num_still = 0;
  for (int64_t path = 0; path < num_paths; ++path) num_still += is_still(path) ? 1 : 0;
  still.reserve(static_cast<size_t>(num_still));
  moving.reserve(static_cast<size_t>(num_paths - num_still));
  for (int64_t path = 0; path < num_paths; ++path) (is_still(path) ? still : moving).push_back(path);
  return split;
}

// Cubes [group] of all groups, in one pass.
std::vector<Cube> synthesize_groups(const Paths& paths, const Radar& radar, const std::vector<uint32_t>* group, int num_groups,
                                    CubeSettings settings, Job* job) {
  settings.replay.per_sample = settings.synthesis.per_sample;
  const Replayer replayer(paths, radar, settings.replay);
  const int64_t num_paths = paths.num_paths();
  Synthesizer synthesizer(radar.waveform, replayer.num_channels(), num_groups, num_paths, settings.synthesis);
  const auto [still, moving] = split_by_motion(replayer, num_paths, job);
  if (job) job->start(num_paths * replayer.num_channels());
  Stream stream{replayer, group, synthesizer, job};
  stream.add_still(still);
  stream.add_moving(moving);

  std::vector<Cube> cubes;
  for (int g = 0; g < num_groups; ++g) {
    cubes.push_back({static_cast<int>(radar.transmitters.size()), static_cast<int>(radar.receivers.size()),
                     radar.waveform.num_chirps, radar.waveform.num_samples, synthesizer.cube(g, job)});
  }
  return cubes;
}

Cube empty_like(const Radar& radar) {
  Cube cube{static_cast<int>(radar.transmitters.size()), static_cast<int>(radar.receivers.size()), radar.waveform.num_chirps,
            radar.waveform.num_samples, {}};
  cube.values.resize(static_cast<size_t>(cube.num_tx) * cube.num_rx * cube.num_chirps * cube.num_samples);
  return cube;
}

// Stretches of a frame with the settings for each.
std::vector<Stretch> stretches_for(const Paths& paths, const Radar& radar, const CubeSettings& settings, Job* job) {
  const int count = num_keyframes(paths, radar, settings.keyframes, settings.replay.specular, job);
  return stretches_of(radar, paths.frame.start_time, count);
}

CubeSettings within_stretch(CubeSettings settings) {
  settings.keyframes = {};
  return settings;
}

void insert_chirps(const Cube& stretch, int first_chirp, Cube& frame) {
  const size_t size = static_cast<size_t>(stretch.num_chirps) * stretch.num_samples;
  const size_t frame_size = static_cast<size_t>(frame.num_chirps) * frame.num_samples;
  const size_t first = static_cast<size_t>(first_chirp) * frame.num_samples;
  for (size_t channel = 0; channel < static_cast<size_t>(frame.num_tx) * frame.num_rx; ++channel) {
    std::copy_n(stretch.values.data() + channel * size, size, frame.values.data() + channel * frame_size + first);
  }
}

}  // namespace

Cube synthesize(const Paths& paths, const Radar& radar, const CubeSettings& settings, Job* job) {
  const Retrace retrace = settings.keyframes.retrace;
  if (retrace == Retrace::kNever) return std::move(synthesize_groups(paths, radar, nullptr, 1, settings, job).front());
  Cube frame = empty_like(radar);
  for (const Stretch& stretch : stretches_for(paths, radar, settings, job)) {
    const Paths record = record_of(paths, stretch, retrace, job);
    insert_chirps(synthesize(record, stretch.radar, within_stretch(settings), job), stretch.first_chirp, frame);
  }
  return frame;
}

namespace {

std::vector<std::vector<PartCube>> decompose_stretches(const Paths& paths, const Radar& radar,
                                                       const std::vector<std::vector<NamedSelection>>& partitions,
                                                       const CubeSettings& settings, Job* job) {
  std::vector<std::vector<PartCube>> frame;
  for (const Stretch& stretch : stretches_for(paths, radar, settings, job)) {
    const Paths record = record_of(paths, stretch, settings.keyframes.retrace, job);
    const auto parts = decompose(record, stretch.radar, partitions, within_stretch(settings), job);
    if (frame.empty()) {
      for (const std::vector<PartCube>& partition : parts) {
        std::vector<PartCube>& whole = frame.emplace_back();
        for (const PartCube& part : partition) whole.push_back({part.name, empty_like(radar)});
      }
    }
    for (size_t i = 0; i < parts.size(); ++i) {
      for (size_t k = 0; k < parts[i].size(); ++k) insert_chirps(parts[i][k].cube, stretch.first_chirp, frame[i][k].cube);
    }
  }
  return frame;
}

}  // namespace

std::vector<std::vector<PartCube>> decompose(const Paths& paths, const Radar& radar,
                                             const std::vector<std::vector<NamedSelection>>& partitions,
                                             const CubeSettings& settings, Job* job) {
  if (settings.keyframes.retrace != Retrace::kNever) return decompose_stretches(paths, radar, partitions, settings, job);
  std::vector<Partition> parts;
  for (const std::vector<NamedSelection>& named : partitions) parts.push_back(make_partition(paths, named, job));
  CombinedPartition combined = combine(std::move(parts), job);
  for (Partition& partition : combined.partitions) partition.group = {};  // only the combination is needed from here on
  const int num_groups = std::max(1, static_cast<int>(combined.num_groups));
  const std::vector<Cube> by_group = synthesize_groups(paths, radar, &combined.group, num_groups, settings, job);

  std::vector<std::vector<PartCube>> out(partitions.size());
  for (size_t i = 0; i < partitions.size(); ++i) {
    const std::vector<std::string>& names = combined.partitions[i].names;
    for (uint32_t part = 0; part < names.size(); ++part) {
      PartCube& made = out[i].emplace_back(PartCube{names[part], empty_like(radar)});
      for (const uint32_t g : combined.groups_of(i, part)) {
        for (size_t k = 0; k < made.cube.values.size(); ++k) made.cube.values[k] += by_group[g].values[k];
      }
    }
  }
  return out;
}

}  // namespace echopath
