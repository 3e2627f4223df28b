#include "echopath/sim/synthesize.h"

#include <algorithm>
#include <span>
#include <utility>

#include "echopath/sim/replay_stream.h"

namespace echopath {
namespace {

void set_groups(const std::vector<uint32_t>& group, std::span<const int64_t> indices, std::span<Echoes> blocks) {
  auto path = indices.begin();
  for (Echoes& block : blocks) {
    for (int64_t i = 0; i < block.num_echoes; ++i) block.group.push_back(group[static_cast<size_t>(*path++)]);
  }
}

// Cubes [group] of all groups, in one pass.
std::vector<Cube> synthesize_groups(const Paths& paths, const Radar& radar, const std::vector<uint32_t>* group, int num_groups,
                                    CubeSettings settings, Job* job) {
  settings.replay.per_sample = settings.synthesis.per_sample;
  ReplayStream stream(paths, radar, settings.replay, job);
  Synthesizer synthesizer(radar.waveform, stream.num_channels(), num_groups, paths.num_paths(), settings.synthesis);
  if (job) job->start(paths.num_paths() * stream.num_channels());
  stream.run([&](int channel, std::span<Echoes> blocks, std::span<const int64_t> indices) {
    if (group) set_groups(*group, indices, blocks);
    synthesizer.add(channel, blocks, job);
  });

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
