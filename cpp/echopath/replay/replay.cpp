#include "echopath/replay/replay.h"

#include <algorithm>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/memory/kept_memory.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/replay/echo_memory.h"
#include "echopath/replay/factors/attenuation.h"
#include "echopath/replay/time/chirp_derivatives.h"

namespace echopath {
namespace {

// With this many paths, the legs and what these are made of stay in the second-level cache.
constexpr size_t kPlannedTogether = 2000;
constexpr int64_t kBlock = 8192;         // paths of a task
constexpr size_t kMomentsTogether = 16;  // more would take memory and save no time

const Radar& checked(const Radar& radar, const Paths& paths, const ReplaySettings& settings) {
  radar.validate();
  require(settings.phase_tolerance > 0, "phase_tolerance", "must be positive", settings.phase_tolerance);
  paths.scene->require_times(paths.frame.start_time, paths.frame.start_time + radar.frame_duration());
  return radar;
}

// Returns the rows in which whole echoes are written; each node that is written takes `step` of them.
std::vector<ChannelNodes> rows_of(std::span<Echoes> echoes, size_t step = 1) {
  std::vector<ChannelNodes> rows;
  for (Echoes& one : echoes) {
    const size_t stride = step * static_cast<size_t>(one.num_echoes);
    rows.push_back({one.delay.data(), one.amplitude.data(), stride, 0, 1.0 / kSpeedOfLight});
  }
  return rows;
}

}  // namespace

struct Replayer::Target {
  const PosedNodes& posed;
  size_t first_channel;  // of those that are posed
  std::vector<ChannelNodes> nodes;
  Wanted wanted = {};  // of all paths
  CellView cells = {};

  ChannelSpan channels() const { return {first_channel, nodes}; }
};

Replayer::Replayer(const Paths& paths, const Radar& radar, const ReplaySettings& settings)
    : paths_(paths), radar_(checked(radar, paths, settings)), settings_(settings), radio_(radio_constants(paths, radar)),
      preparer_(paths, touched_meshes(paths)), sheets_(preparer_, radar.waveform), grids_(paths, radar, settings),
      posed_(grids_, paths, radar, preparer_) {}

PathGrids Replayer::path_grids() {
  return PathGrids(paths_, radar_, grids_, posed_, radio_.wavenumber, settings_.phase_tolerance);
}

int Replayer::num_channels() const { return static_cast<int>(radar_.transmitters.size() * num_receivers()); }

std::vector<Echoes> Replayer::take_echoes(size_t num_echoes, size_t num_channels, size_t num_nodes) const {
  std::vector<Echoes> echoes;
  for (size_t channel = 0; channel < num_channels; ++channel) {
    echoes.push_back(echopath::take_echoes(num_nodes * num_echoes));
    echoes.back().num_echoes = static_cast<int64_t>(num_echoes);
  }
  return echoes;
}

void Replayer::recycle(std::span<Echoes> echoes) const { leave_echoes(echoes); }

JoinRule Replayer::join_rule(std::vector<const std::vector<uint32_t>*> labels) const {
  return {paths_, preparer_, settings_.specular, std::move(labels)};
}

std::vector<Echoes> Replayer::joined(std::vector<Echoes> of_paths, std::span<const uint8_t> joined) const {
  const auto num_left = std::ranges::count(joined, 0);
  if (static_cast<size_t>(num_left) == joined.size()) return of_paths;
  std::vector<Echoes> echoes;
  for (Echoes& all : of_paths) {
    Echoes& to = echoes.emplace_back(echopath::take_echoes(static_cast<size_t>(num_left * all.sampling.num_rows)));
    to.num_echoes = num_left;
    join(all, joined, to);
    to.sampling = std::move(all.sampling);
  }
  recycle(of_paths);
  return echoes;
}

// Makes room for all channels of these transmitters of the grid.
std::vector<Echoes> Replayer::take_echoes_of(const PosedGrid& grid, const SomeTransmitters& transmitters,
                                             size_t num_echoes) const {
  const size_t num_posed = grid.posed.at(0).transmitters.size();
  const size_t num_channels = std::min(transmitters.count, num_posed - transmitters.first) * num_receivers();
  std::vector<Echoes> echoes = take_echoes(num_echoes, num_channels, grid.posed.size());
  for (size_t channel = 0; channel < num_channels; ++channel) {
    echoes[channel].sampling = grid.nodes.sampling[transmitters.first + channel / num_receivers()];
  }
  return echoes;
}

// Evaluates all channels of these transmitters of the grid.
std::vector<Echoes> Replayer::at_nodes(std::span<const int64_t> paths, const PosedGrid& grid,
                                       const SomeTransmitters& transmitters, const Wanted& wanted) const {
  std::vector<Echoes> echoes = take_echoes_of(grid, transmitters, paths.size());
  Target target{grid.posed, transmitters.first * num_receivers(), rows_of(echoes), wanted};
  evaluate_at(paths, {&target, 1});
  return echoes;
}

RadioConstants Replayer::radio_of(const Target& target) const {
  RadioConstants radio = radio_;
  radio.cells = target.cells;
  return radio;
}

std::unique_ptr<PathEvaluator> Replayer::take_evaluator(bool as_chains) const {
  std::unique_ptr<PathEvaluator> evaluator = KeptMemory::of_process().take<PathEvaluator>();
  evaluator->begin(preparer_, radar_, sheets_, settings_.specular, as_chains);
  return evaluator;
}

void Replayer::evaluate_at(std::span<const int64_t> paths, std::span<Target> targets, bool as_chains) const {
  std::unique_ptr<PathEvaluator> evaluator = take_evaluator(as_chains);
  for (size_t begin = 0; begin < paths.size(); begin += kPlannedTogether) {
    evaluator->plan(paths.subspan(begin, std::min(kPlannedTogether, paths.size() - begin)));
    evaluate_planned(*evaluator, begin, targets);
  }
  KeptMemory::of_process().leave(std::move(evaluator));
  attenuate_all(paths.size(), targets);
}

// Writes the paths of the plan to the places from `first` on.
void Replayer::evaluate_planned(PathEvaluator& evaluator, size_t first, std::span<Target> targets) const {
  for (Target& target : targets) {
    for (ChannelNodes& channel : target.nodes) channel.first_path = first;
    Wanted wanted = target.wanted;
    if (wanted.turned) wanted.turned += first;
    if (wanted.unfiltered) wanted.unfiltered += first;
    evaluator.evaluate(target.posed, radio_of(target), target.channels(), wanted);
  }
}

void Replayer::attenuate_all(size_t num_paths, std::span<const Target> targets) const {
  if (paths_.frame.attenuation == 0.0 || num_paths == 0) return;
  for (const Target& target : targets) {
    if (target.wanted.with_amplitudes)
      attenuate(target.channels(), num_paths, target.posed.size(), paths_.frame.attenuation);
  }
}

std::vector<Echoes> Replayer::placed(std::span<const int64_t> indices, std::span<const double> times,
                                     std::span<const Radar> radars) const {
  require(radars.size() == times.size(), "radars", "must be as many as times", radars.size());
  for (const Radar& one : radars) {
    require(one.transmitters.size() == radar_.transmitters.size() && one.receivers.size() == num_receivers(), "radars",
            "must have as many antennas as the radar of the paths", one.transmitters.size());
  }
  std::vector<Echoes> echoes = take_echoes(indices.size(), static_cast<size_t>(num_channels()), times.size());
  if (times.empty()) return echoes;
  const PosedNodes posed = posed_.pose(times, radars);
  Target target{posed, 0, rows_of(echoes)};
  evaluate_at(indices, {&target, 1});
  return echoes;
}

std::vector<Echoes> Replayer::still(std::span<const int64_t> indices, const SomeTransmitters& transmitters) const {
  return at_nodes(indices, posed_.still(), transmitters, {});
}

std::vector<Echoes> Replayer::exact(std::span<const int64_t> indices, const PosedGrid& samples) const {
  require(samples.nodes.sampling.size() == 1, "samples", "must be posed at a SampleGrid, transmitters",
          samples.nodes.sampling.size());
  return at_nodes(indices, samples, {}, {});
}

std::vector<Echoes> Replayer::by_chirp(std::span<const int64_t> indices, GridIndex index, const PosedGrid& chirps,
                                       std::span<const uint8_t> joined) const {
  require(chirps.transmitter >= 0, "chirps", "must be posed at a ChirpGrid, transmitter", chirps.transmitter);
  const PosedGrid& polynomial = posed_.polynomial(index);
  const auto transmitter = static_cast<size_t>(chirps.transmitter);
  const TimeSampling sampling = derivative_sampling(radar_.waveform.num_chirps, grids_.derivatives());
  const std::vector<uint32_t> echo_of = echoes_of(joined);
  const size_t num_echoes = joined.empty() ? indices.size() : echo_of.back() + 1;
  std::vector<Echoes> lengths = take_echoes(num_echoes, num_receivers(), polynomial.posed.size());
  std::vector<Echoes> echoes = take_echoes(num_echoes, num_receivers(), static_cast<size_t>(sampling.num_rows));
  Target targets[] = {{polynomial.posed, transmitter * num_receivers(), rows_of(lengths)},
                      {chirps.posed, 0, rows_of(echoes, static_cast<size_t>(sampling.order))}};
  targets[0].wanted.with_amplitudes = false;
  for (Echoes& channel : echoes) std::ranges::fill(channel.amplitude, 0.0);
  for (Target& target : targets) {
    for (ChannelNodes& nodes : target.nodes) nodes.echo_of = joined.empty() ? nullptr : echo_of.data();
  }
  evaluate_at(indices, targets);
  for (size_t channel = 0; channel < echoes.size(); ++channel) {
    echoes[channel].sampling = sampling;
    fill_derivatives(polynomial.nodes.sampling[transmitter], lengths[channel].delay.data(), echoes[channel]);
  }
  recycle(lengths);
  return echoes;
}

int64_t Replayer::num_rows_by_chirp() const {
  return int64_t{radar_.waveform.num_chirps} * rows_of_chirp(grids_.derivatives());
}

// Evaluates the paths less those that are negligible by what is known without evaluating them, of which dark [P] gets 1.
std::vector<Echoes> Replayer::not_dark(std::span<const int64_t> indices, const PosedGrid& grid,
                                       const SomeTransmitters& transmitters, const Wanted& wanted,
                                       std::vector<uint8_t>& dark) const {
  dark.assign(indices.size(), 0);
  if (strongest_ == 0.0 || indices.size() > kPlannedTogether) return at_nodes(indices, grid, transmitters, wanted);
  std::unique_ptr<PathEvaluator> evaluator = take_evaluator();
  evaluator->plan(indices);
  dark = evaluator->leave_out_dark(grid.posed, grid.nodes, radio_, negligible_amplitude());
  const auto num_left = static_cast<size_t>(std::ranges::count(dark, 0));
  std::vector<Echoes> echoes = take_echoes_of(grid, transmitters, num_left);
  Target target{grid.posed, transmitters.first * num_receivers(), rows_of(echoes), wanted};
  evaluate_planned(*evaluator, 0, {&target, 1});
  KeptMemory::of_process().leave(std::move(evaluator));
  attenuate_all(num_left, {&target, 1});
  return echoes;
}

// Writes the amplitudes without their turns, and the turns (rad) beside.
void Replayer::evaluate_turning(std::span<const int64_t> indices, const PosedGrid& grid, size_t first_channel,
                                std::span<Echoes> channels, std::span<std::vector<double>> turns) const {
  Target target{grid.posed, first_channel, rows_of(channels)};
  for (size_t channel = 0; channel < channels.size(); ++channel) target.nodes[channel].turn = turns[channel].data();
  evaluate_at(indices, {&target, 1}, true);
}

std::vector<Replayer::Moment> Replayer::Moment::in_rows(std::span<const double> times, size_t num_paths, double* lengths,
                                                        std::complex<double>* amplitudes) {
  std::vector<Moment> moments;
  for (size_t i = 0; i < times.size(); ++i) {
    const size_t first = i * num_paths;
    moments.push_back({times[i], lengths ? lengths + first : nullptr, amplitudes ? amplitudes + first : nullptr});
  }
  return moments;
}

void Replayer::evaluate(std::span<const int64_t> indices, std::span<const Moment> moments, Job* job) const {
  for (size_t first = 0; first < moments.size(); first += kMomentsTogether) {
    evaluate_together(indices, moments.subspan(first, std::min(kMomentsTogether, moments.size() - first)), job);
  }
}

void Replayer::evaluate_together(std::span<const int64_t> indices, std::span<const Moment> moments, Job* job) const {
  std::vector<double> times;
  for (const Moment& moment : moments) times.push_back(moment.time);
  const PosedNodes posed = posed_.pose(times);
  Wanted wanted;
  wanted.with_amplitudes = std::ranges::any_of(moments, [](const Moment& one) { return one.amplitudes; });
  parallel_for_chunks(std::ssize(indices), kBlock, [&](size_t begin, size_t end) {
    const size_t size = end - begin;
    std::vector<Echoes> echoes = take_echoes(size, 1, times.size());
    Target target{posed, 0, rows_of(echoes), wanted};
    target.nodes[0].scale = 1.0;  // lengths in place of delays
    evaluate_at(indices.subspan(begin, size), {&target, 1});
    for (size_t node = 0; node < times.size(); ++node) moments[node].take(echoes[0], node * size, size, begin);
    recycle(echoes);
  }, job);
}

void Replayer::evaluate(std::span<const int64_t> indices, double time, std::vector<double>& lengths,
                        std::vector<std::complex<double>>& amplitudes, Job* job) const {
  const CellView as_launched;
  evaluate(indices, time, {&as_launched, 1}, lengths, amplitudes, job);
}

void Replayer::evaluate(std::span<const int64_t> indices, double time, std::span<const CellView> cells,
                        std::vector<double>& lengths, std::vector<std::complex<double>>& amplitudes, Job* job) const {
  const PosedNodes single = posed_.pose({&time, 1});
  const auto channels = static_cast<size_t>(num_channels());
  lengths.resize(channels * indices.size());
  amplitudes.resize(cells.size() * lengths.size());
  parallel_for_chunks(std::ssize(indices), kBlock, [&](size_t begin, size_t end) {
    const size_t size = end - begin;
    std::vector<Target> targets;
    for (size_t view = 0; view < cells.size(); ++view) {
      targets.push_back({single, 0, {}});
      targets.back().cells = cells[view];
      for (size_t channel = 0; channel < channels; ++channel) {
        const size_t to = channel * indices.size() + begin;
        targets.back().nodes.push_back({lengths.data() + to, amplitudes.data() + view * lengths.size() + to, size, 0, 1.0});
      }
    }
    evaluate_at(indices.subspan(begin, size), targets);
  }, job);
}

}  // namespace echopath
