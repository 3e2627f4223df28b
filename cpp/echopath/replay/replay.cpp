#include "echopath/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/kept_memory.h"
#include "echopath/base/parallel.h"
#include "echopath/replay/evaluate/path_evaluator.h"
#include "echopath/replay/spare_echoes.h"
#include "echopath/replay/time/chirp_derivatives.h"
#include "echopath/replay/time/node_tails.h"

namespace echopath {
namespace {

// Paths whose legs and what these are made of stay in the second-level cache.
constexpr size_t kPlannedTogether = 2000;
// Amplitudes in this many chirps cost as much as one more node, with what a level costs that is tried in vain.
constexpr int64_t kWorthOfANode = 5;

// Coefficients fall about geometrically from these: orders above what that makes of a tail are the next to try.
constexpr double kFirstPhase = 100.0;     // rad
constexpr double kFirstAmplitude = 1.0;   // relative to the largest

// The order at which a tail found at `order` would be within its tolerance.
double order_for(double tolerance, double tail, double first, int order) {
  if (tail >= first) return NodeLevels::kHighestOrder;
  return order * std::log(tolerance / first) / std::log(tail / first);
}

const Radar& checked(const Radar& radar, const Paths& paths, const ReplaySettings& settings) {
  radar.validate();
  require(settings.phase_tolerance > 0, "phase_tolerance", "must be positive", settings.phase_tolerance);
  paths.scene->require_times(paths.frame.start_time, paths.frame.start_time + radar.frame_duration());
  return radar;
}

// Rows of nodes of whole echoes; `step` of them for each node that is written.
std::vector<ChannelNodes> rows_of(std::span<Echoes> echoes, size_t step = 1) {
  std::vector<ChannelNodes> rows;
  for (Echoes& one : echoes) {
    const size_t stride = step * static_cast<size_t>(one.num_echoes);
    rows.push_back({one.delay.data(), one.amplitude.data(), stride, 0, 1.0 / kSpeedOfLight});
  }
  return rows;
}

// Leaves the echoes at `places` (ascending) and forgets all others.
void keep(std::span<const size_t> places, Echoes& echoes) {
  const auto count = static_cast<size_t>(echoes.num_echoes), num_nodes = echoes.delay.size() / count;
  for (size_t node = 0; node < num_nodes; ++node) {
    for (size_t i = 0; i < places.size(); ++i) {
      echoes.delay[node * places.size() + i] = echoes.delay[node * count + places[i]];
      echoes.amplitude[node * places.size() + i] = echoes.amplitude[node * count + places[i]];
    }
  }
  echoes.num_echoes = static_cast<int64_t>(places.size());
  echoes.delay.resize(num_nodes * places.size());
  echoes.amplitude.resize(num_nodes * places.size());
}

}  // namespace

struct Replayer::Target {
  const NodeLevel& level;
  size_t first_channel;  // of the level's
  std::vector<ChannelNodes> nodes;
  uint8_t* turned = nullptr;  // [P], or null: ChainEvaluation::mark_turned
  bool with_amplitudes = true;  // else only lengths are of interest
  CellView cells = {};

  ChannelSpan channels() const { return {first_channel, nodes}; }
};

Replayer::Replayer(const Paths& paths, const Radar& radar, const ReplaySettings& settings)
    : paths_(paths), radar_(checked(radar, paths, settings)), settings_(settings), radio_(radio_constants(paths, radar)),
      localise_(paths, hit_patches(paths)), levels_(paths, radar, settings, localise_) {}

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
  return {paths_, localise_, settings_.specular, std::move(labels)};
}

std::vector<Echoes> Replayer::joined(std::vector<Echoes> of_paths, std::span<const uint8_t> joined) const {
  const auto num_left = std::count(joined.begin(), joined.end(), 0);
  if (static_cast<size_t>(num_left) == joined.size()) return of_paths;
  std::vector<Echoes> echoes;
  for (Echoes& all : of_paths) {
    Echoes& to = echoes.emplace_back(echopath::take_echoes(static_cast<size_t>(num_left * all.sampling.num_nodes)));
    to.num_echoes = num_left;
    join(all, joined, to);
    to.sampling = std::move(all.sampling);
  }
  recycle(of_paths);
  return echoes;
}

// Of all channels of the level.
std::vector<Echoes> Replayer::at_nodes(std::span<const int64_t> paths, const NodeLevel& level, uint8_t* turned) const {
  const size_t num_channels = level.instants.front().transmitters.size() * num_receivers();
  std::vector<Echoes> echoes = take_echoes(paths.size(), num_channels, level.instants.size());
  for (size_t channel = 0; channel < num_channels; ++channel) {
    echoes[channel].sampling = level.nodes.sampling[channel / num_receivers()];
  }
  Target target{level, 0, rows_of(echoes), turned};
  evaluate_at(paths, {&target, 1});
  return echoes;
}

RadioConstants Replayer::radio_of(const Target& target) const {
  RadioConstants radio = radio_;
  radio.cells = target.cells;
  return radio;
}

void Replayer::evaluate_at(std::span<const int64_t> paths, std::span<Target> targets) const {
  std::unique_ptr<PathEvaluator> evaluator = KeptMemory::of_process().take<PathEvaluator>();
  evaluator->begin(localise_, radar_, settings_.specular);
  for (size_t begin = 0; begin < paths.size(); begin += kPlannedTogether) {
    evaluator->plan(paths.subspan(begin, std::min(kPlannedTogether, paths.size() - begin)));
    for (Target& target : targets) {
      for (ChannelNodes& channel : target.nodes) channel.first_path = begin;
      uint8_t* const turned = target.turned ? target.turned + begin : nullptr;
      evaluator->evaluate(target.level.view(), radio_of(target), target.channels(), {turned, target.with_amplitudes});
    }
  }
  KeptMemory::of_process().leave(std::move(evaluator));
}

std::vector<Echoes> Replayer::still(std::span<const int64_t> indices) const {
  return at_nodes(indices, levels_.at_trace());
}

std::vector<Echoes> Replayer::exact(std::span<const int64_t> indices, int transmitter) const {
  return at_nodes(indices, levels_.exact(transmitter));
}

std::vector<Echoes> Replayer::by_chirp(std::span<const int64_t> indices, int index, int transmitter,
                                       std::span<const uint8_t> joined) const {
  const NodeLevel &polynomial = levels_.polynomial(index), &centres = levels_.centres(transmitter);
  const TimeSampling sampling = derivative_sampling(radar_.waveform.num_chirps, levels_.derivatives());
  const std::vector<uint32_t> echo_of = echoes_of(joined);
  const size_t num_echoes = joined.empty() ? indices.size() : echo_of.back() + 1;
  std::vector<Echoes> lengths = take_echoes(num_echoes, num_receivers(), polynomial.instants.size());
  std::vector<Echoes> echoes = take_echoes(num_echoes, num_receivers(), static_cast<size_t>(sampling.num_nodes));
  Target targets[] = {{polynomial, static_cast<size_t>(transmitter) * num_receivers(), rows_of(lengths)},
                      {centres, 0, rows_of(echoes, static_cast<size_t>(sampling.order))}};
  targets[0].with_amplitudes = false;
  for (Echoes& channel : echoes) std::fill(channel.amplitude.begin(), channel.amplitude.end(), 0.0);
  for (Target& target : targets) {
    for (ChannelNodes& nodes : target.nodes) nodes.echo_of = joined.empty() ? nullptr : echo_of.data();
  }
  evaluate_at(indices, targets);
  for (size_t channel = 0; channel < echoes.size(); ++channel) {
    echoes[channel].sampling = sampling;
    fill_derivatives(polynomial.nodes.sampling[static_cast<size_t>(transmitter)], lengths[channel].delay.data(), echoes[channel]);
  }
  recycle(lengths);
  return echoes;
}

int64_t Replayer::num_nodes_by_chirp() const { return int64_t{radar_.waveform.num_chirps} * (settings_.per_sample ? 4 : 2); }

// Order at which a path's polynomials would follow it, 0 where they do.
struct Replayer::NeededOrder {
  double length = 0.0, amplitude = 0.0;
};

std::vector<Echoes> Replayer::interpolated(std::span<const int64_t> indices, int index, std::vector<FailedPath>& failed) const {
  const NodeLevel& polynomial = levels_.polynomial(index);
  std::vector<uint8_t> turned(indices.size());
  std::vector<Echoes> echoes = at_nodes(indices, polynomial, turned.data());
  std::vector<NeededOrder> needed(indices.size());
  for (const Echoes& channel : echoes) raise_orders(polynomial.nodes, channel, needed);
  std::vector<size_t> followed;
  for (size_t p = 0; p < indices.size(); ++p) {
    if (needed[p].length == 0.0 && needed[p].amplitude == 0.0) followed.push_back(p);
    else failed.push_back(this->failed(indices[p], index, needed[p], turned[p] != 0));
  }
  if (followed.size() == indices.size()) return echoes;
  for (Echoes& channel : echoes) keep(followed, channel);
  return echoes;
}

// Orders that paths of one channel would need which the polynomials do not follow.
void Replayer::raise_orders(const FrameNodes& nodes, const Echoes& echoes, std::vector<NeededOrder>& needed) const {
  const NodeTails tails = node_tails(nodes, echoes);
  const auto raise = [&](double tolerance, double tail, double first, double& order) {
    if (tail > tolerance) order = std::max(order, order_for(tolerance, tail, first, nodes.order));
  };
  for (size_t p = 0; p < needed.size(); ++p) {
    raise(settings_.phase_tolerance, radio_.wavenumber * kSpeedOfLight * tails.delay[p], kFirstPhase, needed[p].length);
    raise(settings_.amplitude_tolerance, tails.amplitude[p], kFirstAmplitude, needed[p].amplitude);
  }
}

// Amplitudes that a polynomial follows late or never are left to the chirps: those of surfaces that turn, and those that an order
// named by their own tail did not follow.
FailedPath Replayer::failed(int64_t path, int index, const NeededOrder& needed, bool turned) const {
  const int next = levels_.next_polynomial(index, std::max(needed.length, turned ? 0.0 : needed.amplitude));
  const bool was_tried_before = levels_.first_level(path) < index;
  const bool is_costly = next > levels_.num_polynomials() || levels_.num_nodes(next) * kWorthOfANode >= radar_.waveform.num_chirps;
  const bool is_late = turned || was_tried_before || is_costly;
  if (needed.length == 0.0 && is_late) return {path, index, true};
  return {path, next, false};
}

void Replayer::evaluate(std::span<const int64_t> indices, double time, std::vector<double>& lengths,
                        std::vector<std::complex<double>>& amplitudes, Job* job) const {
  const CellView as_launched;
  evaluate(indices, time, {&as_launched, 1}, lengths, amplitudes, job);
}

void Replayer::evaluate(std::span<const int64_t> indices, double time, std::span<const CellView> cells,
                        std::vector<double>& lengths, std::vector<std::complex<double>>& amplitudes, Job* job) const {
  constexpr size_t kBlock = 8192;
  const NodeLevel single = levels_.single(time);
  const auto channels = static_cast<size_t>(num_channels());
  lengths.resize(channels * indices.size());
  amplitudes.resize(cells.size() * lengths.size());
  parallel_for(static_cast<int64_t>((indices.size() + kBlock - 1) / kBlock), [&](int64_t i) {
    const size_t begin = static_cast<size_t>(i) * kBlock, size = std::min(kBlock, indices.size() - begin);
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
