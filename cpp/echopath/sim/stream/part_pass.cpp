#include "echopath/sim/stream/part_pass.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr uint32_t kNotAsked = std::numeric_limits<uint32_t>::max();
constexpr int kFewestSignals = 2;  // which a synthesizer keeps as bands

ReplaySettings replay_of(const CubeSettings& settings) {
  ReplaySettings replay = settings.replay;
  replay.per_sample = settings.synthesis.per_sample;
  return replay;
}

void set_local_groups(std::span<const int64_t> paths, const std::vector<uint32_t>& group, const std::vector<uint32_t>& local,
                      bool as_one, std::span<Echoes> blocks) {
  for (Echoes& block : blocks) {
    const auto count = static_cast<size_t>(block.num_echoes);
    block.group.clear();
    for (size_t i = 0; !as_one && i < count; ++i) block.group.push_back(local[group[paths[i]]]);
    paths = paths.subspan(count);
  }
}

double sum_of_squares(const std::vector<std::complex<double>>& samples) {
  double sum = 0.0;
  for (const std::complex<double>& sample : samples) sum += std::norm(sample);
  return sum;
}

}  // namespace

// Holds the signal to which each group of some sets is added, and the paths of these groups.
struct PartPass::Sorted {
  std::vector<uint32_t> local;  // [num_groups], kNotAsked for others
  std::vector<int64_t> paths;   // set by set, ascending in each
  int num_sets = 0;
  int num_signals = 0;  // of the sets, and behind them of the members of those with several
};

PartPass::PartPass(const Paths& paths, const Radar& radar, std::vector<uint32_t> group, uint32_t num_groups,
                   CubeSettings settings)
    : paths_(paths), radar_(radar), group_(std::move(group)), num_groups_(num_groups), settings_(settings),
      stream_(paths, radar, replay_of(settings), nullptr), whole_(synthesizer(1)) {
  require(group_.size() == static_cast<size_t>(paths.num_paths()), "group", "must have one entry per path", group_.size());
  for (const uint32_t one : group_) require(one < num_groups, "group", "must be below num_groups", one);
  require(settings.keyframes.retrace == Retrace::kNever, "retrace", "must be 'never' for groups some at a time", "another");
  stream_.join({&group_});
  if (settings_.probe) probe_.emplace(paths, radar, stream_.replayer(), settings_.synthesis, *settings_.probe);
}
PartPass::~PartPass() = default;

void PartPass::finish_probe(Job* job) {
  if (probe_) probe_->finish(*settings_.probe, job);
}

Synthesizer PartPass::synthesizer(int num_groups) const {
  return {radar_.waveform, stream_.num_channels(), num_groups, paths_.num_paths(), settings_.synthesis};
}

size_t PartPass::group_bytes() const { return whole_.group_bytes(); }

Cube PartPass::whole(Job* job) const {
  Cube cube = Cube::zeros(radar_);
  cube.values = whole_.cube(0, job);
  return cube;
}

// The groups of a set have one signal, or each its own where they are kept `apart`; then sets whose signals are known have
// no paths.
PartPass::Sorted PartPass::sorted(const Sets& sets, bool apart) const {
  Sorted sorted{std::vector<uint32_t>(num_groups_, kNotAsked), {}, static_cast<int>(sets.size()), 0};
  sorted.num_signals = sorted.num_sets;
  std::vector<uint32_t> set_of(num_groups_, kNotAsked);
  for (size_t set = 0; set < sets.size(); ++set) {
    for (const uint32_t group : sets[set]) {
      require(group < num_groups_, "groups", "must be below num_groups", group);
      const bool is_member = apart && sets[set].size() > 1;
      sorted.local[group] = is_member ? static_cast<uint32_t>(sorted.num_signals++) : static_cast<uint32_t>(set);
      if (!apart || !is_kept(sets[set])) set_of[group] = static_cast<uint32_t>(set);
    }
  }
  std::vector<std::vector<int64_t>> of_set(sets.size());
  for (size_t path = 0; path < group_.size(); ++path) {
    const uint32_t set = set_of[group_[path]];
    if (set != kNotAsked) of_set[set].push_back(static_cast<int64_t>(path));
  }
  for (const std::vector<int64_t>& some : of_set) sorted.paths.insert(sorted.paths.end(), some.begin(), some.end());
  return sorted;
}

std::vector<SummedGroups> PartPass::summed(const Sets& sets, const Sorted& sorted, const Synthesizer& signals) const {
  std::vector<SummedGroups> sums;
  for (const std::vector<uint32_t>& set : sets) {
    SummedGroups& sum = sums.emplace_back(SummedGroups{&signals, {}});
    for (const uint32_t group : set) sum.groups.push_back(static_cast<int>(sorted.local[group]));
    std::ranges::sort(sum.groups);
    sum.groups.erase(std::unique(sum.groups.begin(), sum.groups.end()), sum.groups.end());
    if (is_kept(set)) sum = kept_.at(set.front());
  }
  return sums;
}

void PartPass::forget() {
  kept_.clear();
  kept_signals_.reset();
}

// Keeps the signals where some of them were added to others.
void PartPass::keep(const Sets& sets, const Sorted& sorted, Synthesizer signals) {
  if (sorted.num_signals == sorted.num_sets) return;
  forget();
  signals.leave_scratch();
  kept_signals_.emplace(std::move(signals));
  for (const std::vector<uint32_t>& set : sets) {
    for (const uint32_t group : set)
      kept_.try_emplace(group, SummedGroups{&*kept_signals_, {static_cast<int>(sorted.local[group])}});
  }
}

void PartPass::run(const Sorted& sorted, bool as_one, Synthesizer* out, CellBounds* bounds, Job* job) {
  stream_.set_job(job);
  stream_.watch(adds_up_ && probe_ ? &*probe_ : nullptr);
  if (job) job->start(std::ssize(sorted.paths) * stream_.num_channels());
  stream_.run(sorted.paths, [&](int channel, std::span<Echoes> blocks, const ReplayStream::EchoPaths& of) {
    if (bounds) bounds->see(blocks, of.first);
    if (out) {
      set_local_groups(of.first, group_, sorted.local, as_one, blocks);
      out->add(channel, blocks, job);
    }
    if (job) job->advance(of.count - (out ? std::ssize(of.first) : 0));
  });
  stream_.set_job(nullptr);
}

std::vector<double> PartPass::bounds(const Sets& sets, const MapWindows& window, int zero_pad, Job* job) {
  Sorted some = sorted(sets, false);
  std::ranges::sort(some.paths);  // they go into one signal, for which neighbours among the rays are better
  CellBounds bounds(paths_.num_paths(), radar_, settings_.synthesis.per_sample);
  run(some, true, adds_up_ ? &whole_ : nullptr, &bounds, job);
  std::vector<uint32_t> local;
  for (const uint32_t group : group_) local.push_back(some.local[group]);
  return bounds.bounds(local, static_cast<uint32_t>(some.num_sets), window.range, zero_pad);
}

std::vector<Cube> PartPass::cubes(const Sets& sets, Job* job) {
  const Sorted some = sorted(sets, false);
  Synthesizer signals = synthesizer(std::max(1, some.num_sets));
  run(some, false, &signals, nullptr, job);
  std::vector<Cube> cubes;
  for (int set = 0; set < some.num_sets; ++set) {
    cubes.push_back(Cube::zeros(radar_));
    cubes.back().values = signals.cube(set, job);
  }
  if (adds_up_) whole_.absorb(signals, some.num_sets);
  return cubes;
}

std::vector<SetPower> PartPass::powers(const Sets& sets, const MapWindows& window, int zero_pad, double least, Job* job,
                                       const Ranges& ranges) {
  const MapTransform map(radar_, window, zero_pad);
  require(ranges.empty() || ranges.size() == sets.size(), "ranges", "must have one entry for each set", ranges.size());
  for (const std::vector<uint8_t>& asked : ranges) {
    require(std::ssize(asked) == map.num_ranges(), "ranges", "must have one entry for each range of the map", asked.size());
  }
  const Sorted some = sorted(sets, whole_.spread() != nullptr);
  const auto is_known = [&](const std::vector<uint32_t>& set) { return is_kept(set); };
  if (some.num_signals > some.num_sets && std::ranges::none_of(sets, is_known)) forget();
  Synthesizer signals = synthesizer(std::max(kFewestSignals, some.num_signals));
  run(some, false, &signals, nullptr, job);
  if (adds_up_) whole_.absorb(signals, some.num_signals);
  const std::vector<SummedGroups> sums = summed(sets, some, signals);
  const BandMap band(radar_, window, zero_pad, least > 0.0 || !ranges.empty() ? signals.spread() : nullptr);
  std::vector<SetPower> powers(sets.size());
  parallel_for(some.num_sets, [&](int64_t set) {
    if (job) job->throw_if_cancelled();
    std::vector<uint8_t> asked = ranges.empty() ? std::vector<uint8_t>() : ranges[set];
    if (band.power(sums[set], stream_.num_channels(), least, asked, powers[set])) return;
    powers[set] = power_of(sums[set], map, asked);
  });
  keep(sets, some, std::move(signals));
  return powers;
}

SetPower PartPass::power_of(const SummedGroups& of, const MapTransform& map, std::span<const uint8_t> asked) const {
  const auto num_cells = static_cast<size_t>(map.num_velocities() * map.num_ranges());
  const int num_channels = stream_.num_channels(), num_chirps = radar_.waveform.num_chirps;
  const auto num_samples = static_cast<size_t>(radar_.waveform.num_samples);
  std::vector<std::complex<double>> profiles, values, samples;
  std::vector<double> still(map.num_ranges());  // power of channels where nothing moves
  SetPower power{std::vector<double>(num_cells), 0.0};
  for (int channel = 0; channel < num_channels; ++channel) {
    const auto any = [&](auto is_so) { return std::ranges::any_of(of.groups, is_so); };
    if (!any([&](int group) { return of.signals->has_echoes(channel, group); })) continue;
    const bool moves = any([&](int group) { return !of.signals->is_still(channel, group); });
    samples.assign(num_samples * static_cast<size_t>(moves ? num_chirps : 1), 0.0);
    if (moves) of.signals->write_samples(channel, of.groups, samples.data());
    else of.signals->add_still_samples(channel, of.groups, samples.data());
    if (of.groups.size() == 1) power.mean_square += (moves ? 1 : num_chirps) * sum_of_squares(samples);
    if (!moves) {
      map.add_still(samples.data(), still);
      continue;
    }
    values.resize(num_cells);
    map.transform(samples.data(), profiles, values.data(), asked);
    for (size_t cell = 0; cell < num_cells; ++cell) power.cells[cell] += std::norm(values[cell]);
  }
  map.spread_still(still, power.cells.data());
  for (size_t cell = 0; !asked.empty() && cell < num_cells; ++cell) {
    if (!asked[cell % asked.size()]) power.cells[cell] = 0.0;
  }
  for (double& cell : power.cells) cell /= num_channels;
  power.mean_square /= static_cast<double>(num_channels) * num_chirps * static_cast<double>(num_samples);
  return power;
}

}  // namespace echopath
