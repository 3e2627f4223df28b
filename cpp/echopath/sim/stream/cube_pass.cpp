#include "echopath/sim/stream/cube_pass.h"

#include <optional>
#include <span>

#include "echopath/base/threads/parallel.h"
#include "echopath/sim/stream/replay_stream.h"

namespace echopath {
namespace {

void set_groups(const PathGroups& way, std::span<const int64_t> indices, std::span<Echoes> blocks) {
  std::vector<size_t> first = {0};  // by block
  for (const Echoes& block : blocks) first.push_back(first.back() + static_cast<size_t>(block.num_echoes));
  for (Echoes& block : blocks) block.group.clear();
  if (!way.group) return;
  parallel_for(std::ssize(blocks), [&](int64_t i) {
    std::vector<uint32_t>& group = blocks[i].group;
    group.reserve(first[i + 1] - first[i]);
    for (const int64_t path : indices.subspan(first[i], first[i + 1] - first[i])) {
      group.push_back((*way.group)[path]);
    }
  });
}

// Probes the records of one stretch of a frame and adds up what is found of their chirps.
class StretchProbe {
 public:
  // A null `frame` means that nothing is probed.
  StretchProbe(SignalProbe* frame, const Stretch& stretch) : frame_(frame) {
    if (!frame_) return;
    own_.seed = frame_->seed;
    own_.first_chirp = stretch.first_chirp;
    first_ = frame_->chirps.size();
  }
  ~StretchProbe() { add_last(); }
  StretchProbe(const StretchProbe&) = delete;
  StretchProbe& operator=(const StretchProbe&) = delete;

  // Returns the probe for the next record.
  SignalProbe* next() {
    if (!frame_) return nullptr;
    add_last();
    own_.chirps.clear();
    return &own_;
  }

 private:
  // The same chirps and samples are drawn for each record.
  void add_last() {
    for (size_t i = 0; i < own_.chirps.size(); ++i) {
      if (frame_->chirps.size() <= first_ + i) frame_->chirps.push_back(own_.chirps[i]);
      else frame_->chirps[first_ + i].add(own_.chirps[i]);
    }
  }

  SignalProbe* frame_;
  SignalProbe own_;
  size_t first_ = 0;  // place of the stretch's chirps in those of the frame
};

}  // namespace

Cube Cube::zeros(const Radar& radar) {
  Cube cube{static_cast<int>(radar.transmitters.size()),
            static_cast<int>(radar.receivers.size()),
            radar.waveform.num_chirps,
            radar.waveform.num_samples,
            {}};
  cube.values.resize(static_cast<size_t>(cube.num_tx) * cube.num_rx * cube.num_chirps * cube.num_samples);
  return cube;
}

void Cube::add(const Cube& other) {
  for (size_t i = 0; i < values.size(); ++i) values[i] += other.values[i];
}

void Cube::add_chirps(const Cube& stretch, int first_chirp) {
  const size_t size = static_cast<size_t>(stretch.num_chirps) * stretch.num_samples;
  const size_t frame_size = static_cast<size_t>(num_chirps) * num_samples;
  const size_t first = static_cast<size_t>(first_chirp) * num_samples;
  for (size_t channel = 0; channel < static_cast<size_t>(num_tx) * num_rx; ++channel) {
    const std::complex<double>* from = stretch.values.data() + channel * size;
    std::complex<double>* to = values.data() + channel * frame_size + first;
    for (size_t i = 0; i < size; ++i) to[i] += from[i];
  }
}

CubePass::CubePass(const Paths& paths, const Radar& radar, const std::vector<PathGroups>& ways, CubeSettings settings,
                   Job* job)
    : radar_(radar) {
  settings.replay.per_sample = settings.synthesis.per_sample;
  ReplayStream stream(paths, radar, settings.replay, job);
  std::vector<const std::vector<uint32_t>*> groups;
  for (const PathGroups& way : ways) {
    if (way.group) groups.push_back(way.group);
    synthesizers_.emplace_back(radar.waveform, stream.num_channels(), way.num_groups, paths.num_paths(), settings.synthesis);
  }
  stream.join(groups);
  std::optional<PassProbe> probe;
  if (settings.probe) {
    probe.emplace(paths, radar, stream.replayer(), settings.synthesis, *settings.probe);
    stream.watch(&*probe);
  }
  if (job) job->start(paths.num_paths() * stream.num_channels() * std::ssize(ways));
  stream.run([&](int channel, std::span<Echoes> blocks, const ReplayStream::EchoPaths& of) {
    for (size_t way = 0; way < ways.size(); ++way) {
      set_groups(ways[way], of.first, blocks);
      synthesizers_[way].add(channel, blocks, job);
      if (job) job->advance(of.count - std::ssize(of.first));
    }
  });
  if (probe) probe->finish(*settings.probe, job);
}

Cube CubePass::cube(size_t way, int group, Job* job) const {
  return {static_cast<int>(radar_.transmitters.size()), static_cast<int>(radar_.receivers.size()),
          radar_.waveform.num_chirps, radar_.waveform.num_samples, synthesizers_[way].cube(group, job)};
}

size_t CubePass::cube_bytes() const {
  const size_t channels = radar_.transmitters.size() * radar_.receivers.size();
  const auto samples = static_cast<size_t>(radar_.waveform.num_chirps) * static_cast<size_t>(radar_.waveform.num_samples);
  return channels * samples * sizeof(std::complex<double>);
}

void for_each_record(const Paths& paths, const Radar& radar, const CubeSettings& settings, Job* job,
                     const RecordVisitor& visit) {
  const KeyframeSettings& keyframes = settings.keyframes;
  const int count = num_keyframes(paths, radar, keyframes, settings.replay.specular, job);
  const std::vector<Stretch> stretches = stretches_of(radar, paths.frame.start_time, count);
  StretchRecords records(paths, radar, stretches, keyframes.retrace, job);
  CubeSettings alone = settings;
  alone.keyframes = {};
  for (const Stretch& stretch : stretches) {
    StretchProbe probe(settings.probe, stretch);
    for (const Paths& record : records.of(stretch)) {
      alone.probe = probe.next();
      visit(record, stretch.radar, alone, stretch.first_chirp);
    }
  }
}

}  // namespace echopath
