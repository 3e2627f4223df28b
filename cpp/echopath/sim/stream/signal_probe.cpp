#include "echopath/sim/stream/signal_probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "echopath/base/constants.h"
#include "echopath/base/random.h"
#include "echopath/radar/noise_power.h"
#include "echopath/signal/echoes/echo_states.h"
#include "echopath/signal/kernels/carrier.h"
#include "echopath/signal/kernels/kernels.h"
#include "echopath/signal/methods/per_sample.h"
#include "echopath/sim/stream/probe_sums.h"

namespace echopath {

// Holds an echo as the polynomials have it. It stands in no unnamed namespace, because what PassProbe declares is made of
// it.
struct DrawnEcho {
  int64_t path;
  double delay;                    // s
  std::complex<double> amplitude;  // sqrt(W)
  double strongest;                // W, |amplitude|^2 at the strongest node of the frame
};

namespace {

constexpr int kSamples = ProbedChirp::kSamples;
constexpr int kMostChirps = 2;           // of a pass
constexpr size_t kRandom = 4;            // echoes drawn of a block, beside the strongest
constexpr size_t kEchoesOfChirp = 1024;  // that are evaluated, at most
constexpr double kUnheard = 1e-6;        // of the noise of a cell: the share that counts as nothing
constexpr size_t kSumsOfShare = 4;       // side by side, because additions to one sum would wait for each other

// Returns a number below `count` that depends on nothing but the arguments.
int draw(uint64_t seed, int64_t index, int dimension, int count) {
  const double unit = uniform2(seed, Stream::kProbe, static_cast<uint64_t>(index), static_cast<uint32_t>(dimension))[0];
  return std::min(count - 1, static_cast<int>(unit * count));
}

// Returns |amplitude|^2 in W of an echo at its strongest node.
double power_at_strongest_node(const Echoes& echoes, int64_t echo) {
  const TimeSampling& sampling = echoes.sampling;
  const bool is_logarithm = sampling.rows == TimeSampling::Rows::kLogarithms;
  const int step = sampling.rows == TimeSampling::Rows::kDerivatives ? sampling.order : 1;  // further rows have none
  double most = 0.0;
  for (int64_t row = 0; row < sampling.num_rows; row += step) {
    const std::complex<double> amplitude = echoes.amplitude[row * echoes.num_echoes + echo];
    most = std::max(most, is_logarithm ? std::exp(2.0 * amplitude.real()) : std::norm(amplitude));
  }
  return most;
}

DrawnEcho state_of(const Echoes& block, int chirp, int64_t echo, int64_t path) {
  EchoStates state;
  evaluate_states(block, chirp, echo, 1, state);
  return {path, state.delay[0], {state.amplitude[0], state.amplitude[1]}, power_at_strongest_node(block, echo)};
}

// Keeps at most kEchoesOfChirp: the strongest half and an even choice of the others.
void thin_out(std::vector<DrawnEcho>& echoes) {
  if (echoes.size() <= kEchoesOfChirp) return;
  std::ranges::stable_sort(
      echoes, [](const DrawnEcho& a, const DrawnEcho& b) { return std::norm(a.amplitude) > std::norm(b.amplitude); });
  const size_t half = kEchoesOfChirp / 2, others = echoes.size() - half;
  for (size_t i = 0; i < half; ++i) echoes[half + i] = echoes[half + i * others / half];
  echoes.resize(kEchoesOfChirp);
}

}  // namespace

// Holds what was seen of one block, or of all so far.
struct PassProbe::EchoTally {
  explicit EchoTally(size_t num_shares) : rows(num_shares + 1), power(num_shares * kSumsOfShare) {}
  std::vector<SampleRow> rows;  // coherent paths of each share; the last: paths over rough surfaces, whatever their share
  std::vector<double> power;    // W of the latter, [share, kSumsOfShare]; the sums side by side add up
  double power_sum = 0.0, strongest = 0.0;  // W
  double amplitude_sum = 0.0;
  std::vector<DrawnEcho> drawn;
};

// Holds a chirp of a channel that is probed, and what was seen of it so far.
struct PassProbe::ChirpTarget {
  explicit ChirpTarget(size_t num_shares) : tally(num_shares) {}
  int channel = 0, chirp = 0;
  int num_samples = 0;  // that differ; the others repeat them
  SampleSums sample{};  // evenly spaced, from the first of the chirp
  EchoTally tally;
  std::array<std::optional<EchoTally>, kMostBlocksOfFlight> of_block;
};

void ProbedChirp::add(const ProbedChirp& other) {
  for (size_t s = 0; s < value.size(); ++s) value[s] += other.value[s];
  amplitude_sum += other.amplitude_sum;
  num_echoes += other.num_echoes;
  const auto of_both = [](double error, double& power, double other_error, double other_power) {
    const double squares = error * error * power + other_error * other_error * other_power;
    power += other_power;
    return power > 0.0 ? std::sqrt(squares / power) : std::max(error, other_error);
  };
  phase_error = of_both(phase_error, compared_power, other.phase_error, other.compared_power);
  largest_phase_error = std::max(largest_phase_error, other.largest_phase_error);
  amplitude_error = of_both(amplitude_error, strongest_power, other.amplitude_error, other.strongest_power);
  for (size_t i = 0; i < shares.size(); ++i) {
    for (size_t s = 0; s < shares[i].field.size(); ++s) shares[i].field[s] += other.shares[i].field[s];
    shares[i].power += other.shares[i].power;
  }
  power_sum += other.power_sum;
  strongest = std::max(strongest, other.strongest);
}

PassProbe::PassProbe(const Paths& paths, const Radar& radar, const Replayer& replayer, const SynthesisOptions& synthesis,
                     const SignalProbe& probe)
    : paths_(paths), radar_(radar), replayer_(replayer), model_(radar.waveform, 0), seed_(probe.seed) {
  if (synthesis.per_sample) per_sample_ = std::make_unique<PerSample>(radar.waveform, model_);
  const int num_chirps = std::min(kMostChirps, replayer.num_channels());
  for (int i = 0; i < num_chirps; ++i) {
    const int64_t index = int64_t{probe.first_chirp} * kMostChirps + i;
    ChirpTarget& target = targets_.emplace_back(num_shares());
    target.channel = draw(seed_, index, 0, replayer.num_channels());
    target.chirp = draw(seed_, index, 1, radar.waveform.num_chirps);
    draw_samples(seed_, index, radar.waveform.num_samples, target);
  }
}

// Takes steps of half the longest to the longest, because neighbouring samples would all see the same.
void PassProbe::draw_samples(uint64_t seed, int64_t index, int num_samples, ChirpTarget& target) {
  target.num_samples = std::min(kSamples, num_samples);
  const int longest = std::max(1, (num_samples - 1) / (kSamples - 1)), shortest = (longest + 1) / 2;
  const int step = shortest + draw(seed, index, 2, longest - shortest + 1);
  const int first = draw(seed, index, 3, num_samples - (target.num_samples - 1) * step);
  for (int s = 0; s < kSamples; ++s) target.sample[s] = first + s * step;
}

PassProbe::~PassProbe() = default;

bool PassProbe::watches(int channel) const {
  return std::ranges::any_of(targets_, [&](const ChirpTarget& target) { return target.channel == channel; });
}

void PassProbe::see(int channel, size_t block, const Echoes& echoes, std::span<const int64_t> paths) {
  for (ChirpTarget& target : targets_) {
    if (target.channel == channel) tally_block(target, echoes, paths, target.of_block[block].emplace(num_shares()));
  }
}

void PassProbe::end_blocks() {
  for (ChirpTarget& target : targets_) {
    for (std::optional<EchoTally>& some : target.of_block) {
      if (some) add(*some, target.tally);
      some.reset();
    }
  }
}

size_t PassProbe::num_shares() const { return 2 * static_cast<size_t>(paths_.frame.batches) + 1; }

void PassProbe::add(const EchoTally& some, EchoTally& all) {
  for (size_t row = 0; row < all.rows.size(); ++row) {
    for (size_t s = 0; s < kSamples; ++s) {
      all.rows[row].re[s] += some.rows[row].re[s];
      all.rows[row].im[s] += some.rows[row].im[s];
    }
  }
  for (size_t share = 0; share < all.power.size(); ++share) all.power[share] += some.power[share];
  all.power_sum += some.power_sum;
  all.strongest = std::max(all.strongest, some.strongest);
  all.amplitude_sum += some.amplitude_sum;
  all.drawn.insert(all.drawn.end(), some.drawn.begin(), some.drawn.end());
}

void PassProbe::tally_block(const ChirpTarget& target, const Echoes& block, std::span<const int64_t> paths,
                            EchoTally& tally) const {
  constexpr int kCapacity = EchoStates::kCapacity;
  EchoStates states;
  alignas(64) double power[kCapacity];
  uint32_t row[kCapacity];
  StrongestEchoes strongest;
  TonesOfRows tones(tally.rows.size());
  for (int64_t begin = 0; begin < block.num_echoes; begin += kCapacity) {
    const int count = static_cast<int>(std::min<int64_t>(kCapacity, block.num_echoes - begin));
    evaluate_states(block, target.chirp, begin, count, states);
    const EchoPowerSums sums = powers_of(states, count, power);
    tally.amplitude_sum = std::accumulate(std::begin(sums.root), std::end(sums.root), tally.amplitude_sum);
    tally.power_sum = std::accumulate(std::begin(sums.power), std::end(sums.power), tally.power_sum);
    strongest.show(power, *std::max_element(std::begin(sums.largest), std::end(sums.largest)), begin, count);
    sort_paths(paths.subspan(static_cast<size_t>(begin), static_cast<size_t>(count)), power, row, tally);
    add_samples(target, block, begin, states, {row, static_cast<size_t>(count)}, tones, tally);
  }
  tones.give(tally.rows);
  if (!block.sampling.is_static()) draw_echoes(target, block, paths, strongest, tally);
}

// Finds the row of each path. `power` is that of each, W.
void PassProbe::sort_paths(std::span<const int64_t> paths, const double* power, uint32_t* row, EchoTally& tally) const {
  const auto images = static_cast<uint32_t>(num_shares() - 1);
  double strongest = tally.strongest;
  for (size_t i = 0; i < paths.size(); ++i) {
    const auto path = static_cast<size_t>(paths[i]);
    const uint8_t batch = paths_.batch[path];
    const uint32_t share = batch == kNoBatch ? images : 2u * batch + ((paths_.flags[path] & kSecondHalf) != 0 ? 1u : 0u);
    const bool is_rough = paths_.diffuse[path] != 0;
    row[i] = is_rough ? images + 1 : share;
    tally.power[share * kSumsOfShare + i % kSumsOfShare] += is_rough ? power[i] : 0.0;
    if (share != images) strongest = std::max(strongest, power[i]);
  }
  tally.strongest = strongest;
}

void PassProbe::add_samples(const ChirpTarget& target, const Echoes& block, int64_t begin, const EchoStates& states,
                            std::span<const uint32_t> row, TonesOfRows& tones, EchoTally& tally) const {
  const int count = static_cast<int>(row.size());
  if (per_sample_ && !block.sampling.is_static()) {
    for (int i = 0; i < count; ++i) {
      SampleRow& to = tally.rows[row[i]];
      per_sample_->add_samples(block, target.chirp, begin + i, 1, target.sample, to.re, to.im);
    }
    return;
  }
  Carriers carriers;
  carriers.count = count;
  carriers.group = row.data();
  signal_kernels().modulate(model_, states, count, carriers);
  tones.add(carriers, target.sample[0], target.sample[1] - target.sample[0]);
}

void PassProbe::draw_echoes(const ChirpTarget& target, const Echoes& block, std::span<const int64_t> paths,
                            const StrongestEchoes& strongest, EchoTally& tally) const {
  std::vector<int64_t> echoes;
  strongest.append_to(echoes);
  for (size_t i = 0; i < kRandom && block.num_echoes > 0; ++i) {
    echoes.push_back(draw(seed_, paths.front(), -1 - static_cast<int>(i), static_cast<int>(block.num_echoes)));
  }
  std::ranges::sort(echoes);
  echoes.erase(std::unique(echoes.begin(), echoes.end()), echoes.end());
  for (const int64_t echo : echoes) {
    const DrawnEcho drawn = state_of(block, target.chirp, echo, paths[echo]);
    if (drawn.strongest > 0.0) tally.drawn.push_back(drawn);
  }
}

void PassProbe::finish(SignalProbe& probe, Job* job) {
  const int num_receivers = static_cast<int>(radar_.receivers.size());
  for (ChirpTarget& target : targets_) {
    ProbedChirp& chirp = probe.chirps.emplace_back();
    chirp.tx = target.channel / num_receivers;
    chirp.rx = target.channel % num_receivers;
    chirp.chirp = probe.first_chirp + target.chirp;
    chirp.amplitude_sum = target.tally.amplitude_sum;
    sum_up(target, chirp);
    thin_out(target.tally.drawn);
    compare_echoes(target, chirp, job);
  }
}

void PassProbe::sum_up(const ChirpTarget& target, ProbedChirp& chirp) const {
  const EchoTally& tally = target.tally;
  chirp.power_sum = tally.power_sum;
  chirp.strongest = tally.strongest;
  chirp.shares.resize(num_shares());
  for (size_t s = 0; s < kSamples; ++s) {
    const size_t from = s % static_cast<size_t>(target.num_samples);
    chirp.sample[s] = static_cast<int>(target.sample[from]);
    for (const SampleRow& row : tally.rows) chirp.value[s] += std::complex<double>(row.re[from], row.im[from]);
    if (radar_.waveform.falls()) chirp.value[s] = std::conj(chirp.value[s]);
    if (radar_.waveform.real) chirp.value[s] = std::numbers::sqrt2 * chirp.value[s].real();
    for (size_t share = 0; share < num_shares(); ++share) {
      chirp.shares[share].field[s] = {tally.rows[share].re[from], tally.rows[share].im[from]};
    }
  }
  for (size_t share = 0; share < num_shares(); ++share) {
    const auto first = tally.power.begin() + static_cast<ptrdiff_t>(share * kSumsOfShare);
    chirp.shares[share].power = std::accumulate(first, first + kSumsOfShare, 0.0);
  }
}

void PassProbe::compare_echoes(const ChirpTarget& target, ProbedChirp& chirp, Job* job) const {
  const std::vector<DrawnEcho>& drawn = target.tally.drawn;
  if (drawn.empty()) return;
  std::vector<int64_t> paths;
  for (const DrawnEcho& echo : drawn) paths.push_back(echo.path);
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  replayer_.evaluate(paths, paths_.frame.start_time + radar_.chirp_time(chirp.tx, target.chirp), lengths, amplitudes, job);
  const size_t first = static_cast<size_t>(target.channel) * paths.size();
  const double wavenumber = kTwoPi * radar_.waveform.start_frequency / kSpeedOfLight;
  double power = 0.0, strongest = 0.0, of_phase = 0.0, of_amplitude = 0.0;
  for (size_t i = 0; i < paths.size(); ++i) {
    const std::complex<double> exact = amplitudes[first + i];
    power += std::norm(exact);
    strongest += std::max(std::norm(exact), drawn[i].strongest);
    of_amplitude += std::norm(drawn[i].amplitude - exact);
    if (exact == 0.0) continue;
    const double phase = wavenumber * std::abs(kSpeedOfLight * drawn[i].delay - lengths[first + i]);
    of_phase += std::norm(exact) * phase * phase;
    chirp.largest_phase_error = std::max(chirp.largest_phase_error, phase);
  }
  chirp.num_echoes = std::ssize(paths);
  chirp.compared_power = power;
  if (power > 0.0) chirp.phase_error = std::sqrt(of_phase / power);
  // Polynomials follow an amplitude to a share of its largest over the frame, and none that nobody could hear.
  chirp.strongest_power = std::max(strongest, kUnheard * noise_power_in_cell(radar_));
  chirp.amplitude_error = std::sqrt(of_amplitude / chirp.strongest_power);
}

}  // namespace echopath
