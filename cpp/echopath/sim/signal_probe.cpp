#include "echopath/sim/signal_probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/lanes.h"
#include "echopath/base/parallel.h"
#include "echopath/base/phasor.h"
#include "echopath/base/random.h"
#include "echopath/base/simd.h"
#include "echopath/signal/carrier.h"
#include "echopath/signal/echo_states.h"
#include "echopath/signal/kernels.h"
#include "echopath/signal/per_sample.h"

namespace echopath {
namespace {

constexpr int kSamples = ProbedChirp::kSamples;
constexpr int kMostChirps = 2;  // of a pass
constexpr size_t kStrongest = 4, kRandom = 4;  // echoes drawn of a block
constexpr size_t kEchoesOfChirp = 1024;        // that are evaluated, at most
constexpr size_t kSumsOfShare = 4;             // side by side: one would wait for itself

// Sums of kSamples samples; also offsets of these in samples from the first of the chirp.
using SampleSums = std::array<double, kSamples>;

// Samples of each row, real parts first.
struct SampleRow {
  SampleSums re{}, im{};
};

// Carriers side by side.
constexpr int kMostLanes = 8;

// Adds carriers, as many as fill whole lanes, to sums [2, kSamples, kLanes] over samples that are evenly spaced: one phasor for the
// first and one for the step between them.
template <int kLanes>
ECHOPATH_INLINE void add_tones(const double* frequency, const double* re, const double* im, int count, double first, double step,
                               double* sums) {
  using Vec = Lanes<double, kLanes>;
  Vec sum_re[kSamples], sum_im[kSamples];
  for (int s = 0; s < kSamples; ++s) {
    sum_re[s] = load_lanes<kLanes>(sums + s * kLanes);
    sum_im[s] = load_lanes<kLanes>(sums + (kSamples + s) * kLanes);
  }
  for (int p = 0; p < count; p += kLanes) {
    const Vec f = load_lanes<kLanes>(frequency + p), a = load_lanes<kLanes>(re + p), b = load_lanes<kLanes>(im + p);
    const auto start = phasor_of_cycles(f * first), turn = phasor_of_cycles(f * step);
    Vec c = a * start.re - b * start.im, d = a * start.im + b * start.re;
    for (int s = 0; s < kSamples; ++s) {
      sum_re[s] += c;
      sum_im[s] += d;
      const Vec next = c * turn.re - d * turn.im;
      d = c * turn.im + d * turn.re;
      c = next;
    }
  }
  for (int s = 0; s < kSamples; ++s) {
    store_lanes(sums + s * kLanes, sum_re[s]);
    store_lanes(sums + (kSamples + s) * kLanes, sum_im[s]);
  }
}

// A number below `count` for the k-th draw of a pass that begins with a chirp of the frame.
int draw(uint64_t seed, int64_t index, int dimension, int count) {
  const double unit = uniform2(seed, Stream::kProbe, static_cast<uint64_t>(index), static_cast<uint32_t>(dimension))[0];
  return std::min(count - 1, static_cast<int>(unit * count));
}

// Of some echoes, in kLanes sums side by side.
struct PowerSums {
  static constexpr int kLanes = 8;
  double power[kLanes] = {}, root[kLanes] = {}, largest[kLanes] = {};
};

// Powers of echoes, as many as fill whole lanes: those behind the last are 0.
ECHOPATH_INLINE void find_powers(const double* amplitude, int count, double* __restrict power, PowerSums* out) {
  for (int p = 0; p < count; ++p) power[p] = amplitude[2 * p] * amplitude[2 * p] + amplitude[2 * p + 1] * amplitude[2 * p + 1];
  PowerSums sums;
  for (int p = 0; p < count; p += PowerSums::kLanes) {
    for (int lane = 0; lane < PowerSums::kLanes; ++lane) {
      const double here = power[p + lane];
      sums.power[lane] += here;
      sums.root[lane] += std::sqrt(here);
      sums.largest[lane] = std::max(sums.largest[lane], here);
    }
  }
  *out = sums;
}

// Of dark paths: 0 at all nodes.
bool is_dark(const Echoes& echoes, int64_t echo) {
  for (size_t i = static_cast<size_t>(echo); i < echoes.amplitude.size(); i += static_cast<size_t>(echoes.num_echoes)) {
    if (echoes.amplitude[i] != 0.0) return false;
  }
  return true;
}

// An echo as the polynomials have it.
struct DrawnEcho {
  int64_t path;
  double delay;                    // s
  std::complex<double> amplitude;  // sqrt(W)
};

DrawnEcho state_of(const Echoes& block, int chirp, int64_t echo, int64_t path) {
  EchoStates state;
  evaluate_states(block, chirp, echo, 1, state);
  return {path, state.delay[0], {state.amplitude[0], state.amplitude[1]}};
}

// power: room for EchoStates::kCapacity of them, W.
PowerSums powers_of(EchoStates& states, int count, double* power) {
  const int filled = (count + PowerSums::kLanes - 1) / PowerSums::kLanes * PowerSums::kLanes;
  std::fill(states.amplitude + 2 * count, states.amplitude + 2 * filled, 0.0);
  PowerSums sums;
  run_simd<find_powers>(states.amplitude, filled, power, &sums);
  return sums;
}

// At most kEchoesOfChirp: the strongest half and an even choice of the others.
void thin_out(std::vector<DrawnEcho>& echoes) {
  if (echoes.size() <= kEchoesOfChirp) return;
  std::stable_sort(echoes.begin(), echoes.end(),
                   [](const DrawnEcho& a, const DrawnEcho& b) { return std::norm(a.amplitude) > std::norm(b.amplitude); });
  const size_t half = kEchoesOfChirp / 2, others = echoes.size() - half;
  for (size_t i = 0; i < half; ++i) echoes[half + i] = echoes[half + i * others / half];
  echoes.resize(kEchoesOfChirp);
}

}  // namespace

// The few strongest of the echoes that are shown to it, strongest first.
class PassProbe::Strongest {
 public:
  // largest: of these, W.
  void show(const double* power, double largest, int64_t first, int count) {
    if (largest <= best_.back().first) return;
    for (int p = 0; p < count; ++p) {
      if (power[p] > best_.back().first) insert(power[p], first + p);
    }
  }
  void append_to(std::vector<int64_t>& echoes) const {
    for (const auto& [power, echo] : best_) {
      if (power > 0.0) echoes.push_back(echo);
    }
  }

 private:
  void insert(double power, int64_t echo) {
    size_t i = kStrongest - 1;
    for (; i > 0 && best_[i - 1].first < power; --i) best_[i] = best_[i - 1];
    best_[i] = {power, echo};
  }
  std::array<std::pair<double, int64_t>, kStrongest> best_{};
};

// Carriers of some echoes in the order of their rows, each row filled up to whole lanes, and sums of them.
struct PassProbe::Tones {
  explicit Tones(size_t num_rows) : first(num_rows + 1), count(num_rows), sums(num_rows * kSums) {
    for (std::vector<double>* values : {&frequency, &re, &im}) values->resize(Carriers::kCapacity + num_rows * kMostLanes);
  }
  static constexpr size_t kSums = 2 * kSamples * kMostLanes;
  std::vector<double> frequency, re, im;
  std::vector<int> first, count;  // [row]
  std::vector<double> sums;       // [row, kSums]

  void sort(const Carriers& carriers) {
    std::fill(count.begin(), count.end(), 0);
    for (int p = 0; p < carriers.count; ++p) ++count[carriers.group[p]];
    for (size_t row = 0; row < count.size(); ++row) {
      first[row + 1] = first[row] + (count[row] + kMostLanes - 1) / kMostLanes * kMostLanes;
      for (std::vector<double>* values : {&frequency, &re, &im}) {
        std::fill(values->begin() + first[row] + count[row], values->begin() + first[row + 1], 0.0);
      }
      count[row] = first[row];
    }
    for (int p = 0; p < carriers.count; ++p) {
      const auto to = static_cast<size_t>(count[carriers.group[p]]++);
      frequency[to] = carriers.frequency[p];
      re[to] = carriers.re[p];
      im[to] = carriers.im[p];
    }
  }

  void add(const Carriers& carriers, double first_sample, double step) {
    sort(carriers);
    const bool is_wide = instruction_set() == InstructionSet::kAvx512;
    for (size_t row = 0; row < count.size(); ++row) {
      const auto at = static_cast<size_t>(first[row]);
      const int num_tones = first[row + 1] - first[row];
      double* const to = sums.data() + row * kSums;
      if (num_tones == 0) continue;
      if (is_wide) run_simd<add_tones<8>>(&frequency[at], &re[at], &im[at], num_tones, first_sample, step, to);
      else run_simd<add_tones<4>>(&frequency[at], &re[at], &im[at], num_tones, first_sample, step, to);
    }
  }

  void give(std::vector<SampleRow>& rows) const {
    const size_t lanes = instruction_set() == InstructionSet::kAvx512 ? 8 : 4;
    for (size_t row = 0; row < rows.size(); ++row) {
      const double* from = sums.data() + row * kSums;
      for (size_t s = 0; s < kSamples; ++s, from += lanes) {
        rows[row].re[s] = std::accumulate(from, from + lanes, rows[row].re[s]);
        rows[row].im[s] = std::accumulate(from + kSamples * lanes, from + (kSamples + 1) * lanes, rows[row].im[s]);
      }
    }
  }
};

// Of one block.
struct PassProbe::Seen {
  explicit Seen(size_t num_shares) : rows(num_shares + 1), power(num_shares * kSumsOfShare) {}
  std::vector<SampleRow> rows;  // coherent paths of each share; the last: paths over rough surfaces, whatever their share
  std::vector<double> power;    // W of these, [share, kSumsOfShare] whose sum it is
  double power_sum = 0.0, strongest = 0.0;  // W
  double amplitude_sum = 0.0;
  std::vector<DrawnEcho> drawn;
};

// A chirp of a channel, and what was seen of it so far.
struct PassProbe::Aim {
  explicit Aim(size_t num_shares) : seen(num_shares) {}
  int channel = 0, chirp = 0;
  int num_samples = 0;  // that differ; the others repeat them
  SampleSums sample{};  // evenly spaced, from the first of the chirp
  Seen seen;
  std::array<std::optional<Seen>, ReplayStream::kBlocksInFlight> of_block;
};

void ProbedChirp::add(const ProbedChirp& other) {
  for (size_t s = 0; s < value.size(); ++s) value[s] += other.value[s];
  amplitude_sum += other.amplitude_sum;
  num_echoes += other.num_echoes;
  phase_error = std::max(phase_error, other.phase_error);
  largest_phase_error = std::max(largest_phase_error, other.largest_phase_error);
  amplitude_error = std::max(amplitude_error, other.amplitude_error);
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
    Aim& aim = aims_.emplace_back(num_shares());
    aim.channel = draw(seed_, index, 0, replayer.num_channels());
    aim.chirp = draw(seed_, index, 1, radar.waveform.num_chirps);
    draw_samples(seed_, index, radar.waveform.num_samples, aim);
  }
}

// Steps of half the longest to the longest: samples far apart see what neighbours would see together.
void PassProbe::draw_samples(uint64_t seed, int64_t index, int num_samples, Aim& aim) {
  aim.num_samples = std::min(kSamples, num_samples);
  const int longest = std::max(1, (num_samples - 1) / (kSamples - 1)), shortest = (longest + 1) / 2;
  const int step = shortest + draw(seed, index, 2, longest - shortest + 1);
  const int first = draw(seed, index, 3, num_samples - (aim.num_samples - 1) * step);
  for (int s = 0; s < kSamples; ++s) aim.sample[static_cast<size_t>(s)] = first + s * step;
}

PassProbe::~PassProbe() = default;

bool PassProbe::watches(int channel) const {
  return std::any_of(aims_.begin(), aims_.end(), [&](const Aim& aim) { return aim.channel == channel; });
}

void PassProbe::see(int channel, size_t block, const Echoes& echoes, std::span<const int64_t> paths) {
  for (Aim& aim : aims_) {
    if (aim.channel == channel) look(aim, echoes, paths, aim.of_block[block].emplace(num_shares()));
  }
}

void PassProbe::end_blocks() {
  for (Aim& aim : aims_) {
    for (std::optional<Seen>& some : aim.of_block) {
      if (some) add(*some, aim.seen);
      some.reset();
    }
  }
}

size_t PassProbe::num_shares() const { return 2 * static_cast<size_t>(paths_.frame.num_batches) + 1; }

void PassProbe::add(const Seen& some, Seen& all) {
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

void PassProbe::look(const Aim& aim, const Echoes& block, std::span<const int64_t> paths, Seen& seen) const {
  constexpr int kCapacity = EchoStates::kCapacity;
  EchoStates states;
  alignas(64) double power[kCapacity];
  uint32_t row[kCapacity];
  Strongest strongest;
  Tones tones(seen.rows.size());
  for (int64_t begin = 0; begin < block.num_echoes; begin += kCapacity) {
    const int count = static_cast<int>(std::min<int64_t>(kCapacity, block.num_echoes - begin));
    evaluate_states(block, aim.chirp, begin, count, states);
    const PowerSums sums = powers_of(states, count, power);
    seen.amplitude_sum = std::accumulate(std::begin(sums.root), std::end(sums.root), seen.amplitude_sum);
    seen.power_sum = std::accumulate(std::begin(sums.power), std::end(sums.power), seen.power_sum);
    strongest.show(power, *std::max_element(std::begin(sums.largest), std::end(sums.largest)), begin, count);
    sort_paths(paths.subspan(static_cast<size_t>(begin), static_cast<size_t>(count)), power, row, seen);
    add_samples(aim, block, begin, states, {row, static_cast<size_t>(count)}, tones, seen);
  }
  tones.give(seen.rows);
  if (!block.sampling.is_static()) draw_echoes(aim, block, paths, strongest, seen);
}

// The row of each path. `power`: W of each.
void PassProbe::sort_paths(std::span<const int64_t> paths, const double* power, uint32_t* row, Seen& seen) const {
  const auto images = static_cast<uint32_t>(num_shares() - 1);
  double strongest = seen.strongest;
  for (size_t i = 0; i < paths.size(); ++i) {
    const auto path = static_cast<size_t>(paths[i]);
    const uint8_t batch = paths_.batch[path];
    const uint32_t share = batch == kNoBatch ? images : 2u * batch + ((paths_.flags[path] & kSecondHalf) != 0 ? 1u : 0u);
    const bool is_rough = paths_.diffuse[path] != 0;
    row[i] = is_rough ? images + 1 : share;
    seen.power[share * kSumsOfShare + i % kSumsOfShare] += is_rough ? power[i] : 0.0;
    if (share != images) strongest = std::max(strongest, power[i]);
  }
  seen.strongest = strongest;
}

void PassProbe::add_samples(const Aim& aim, const Echoes& block, int64_t begin, const EchoStates& states,
                            std::span<const uint32_t> row, Tones& tones, Seen& seen) const {
  const int count = static_cast<int>(row.size());
  if (per_sample_ && !block.sampling.is_static()) {
    for (int i = 0; i < count; ++i) {
      SampleRow& to = seen.rows[row[static_cast<size_t>(i)]];
      per_sample_->add_samples(block, aim.chirp, begin + i, 1, aim.sample, to.re, to.im);
    }
    return;
  }
  Carriers carriers;
  carriers.count = count;
  carriers.group = row.data();
  signal_kernels().modulate(model_, states, count, carriers);
  tones.add(carriers, aim.sample[0], aim.sample[1] - aim.sample[0]);
}

void PassProbe::draw_echoes(const Aim& aim, const Echoes& block, std::span<const int64_t> paths, const Strongest& strongest,
                            Seen& seen) const {
  std::vector<int64_t> echoes;
  strongest.append_to(echoes);
  for (size_t i = 0; i < kRandom && block.num_echoes > 0; ++i) {
    echoes.push_back(draw(seed_, paths.front(), -1 - static_cast<int>(i), static_cast<int>(block.num_echoes)));
  }
  std::sort(echoes.begin(), echoes.end());
  echoes.erase(std::unique(echoes.begin(), echoes.end()), echoes.end());
  for (const int64_t echo : echoes) {
    if (!is_dark(block, echo)) seen.drawn.push_back(state_of(block, aim.chirp, echo, paths[static_cast<size_t>(echo)]));
  }
}

void PassProbe::finish(SignalProbe& probe, Job* job) {
  const int num_receivers = static_cast<int>(radar_.receivers.size());
  for (Aim& aim : aims_) {
    ProbedChirp& chirp = probe.chirps.emplace_back();
    chirp.tx = aim.channel / num_receivers;
    chirp.rx = aim.channel % num_receivers;
    chirp.chirp = probe.first_chirp + aim.chirp;
    chirp.amplitude_sum = aim.seen.amplitude_sum;
    sum_up(aim, chirp);
    thin_out(aim.seen.drawn);
    compare_echoes(aim, chirp, job);
  }
}

void PassProbe::sum_up(const Aim& aim, ProbedChirp& chirp) const {
  const Seen& seen = aim.seen;
  chirp.power_sum = seen.power_sum;
  chirp.strongest = seen.strongest;
  chirp.shares.resize(num_shares());
  for (size_t s = 0; s < kSamples; ++s) {
    const size_t from = s % static_cast<size_t>(aim.num_samples);
    chirp.sample[s] = static_cast<int>(aim.sample[from]);
    for (const SampleRow& row : seen.rows) chirp.value[s] += std::complex<double>(row.re[from], row.im[from]);
    if (radar_.waveform.real) chirp.value[s] = std::numbers::sqrt2 * chirp.value[s].real();
    for (size_t share = 0; share < num_shares(); ++share) {
      chirp.shares[share].field[s] = {seen.rows[share].re[from], seen.rows[share].im[from]};
    }
  }
  for (size_t share = 0; share < num_shares(); ++share) {
    const auto first = seen.power.begin() + static_cast<ptrdiff_t>(share * kSumsOfShare);
    chirp.shares[share].power = std::accumulate(first, first + kSumsOfShare, 0.0);
  }
}

void PassProbe::compare_echoes(const Aim& aim, ProbedChirp& chirp, Job* job) const {
  const std::vector<DrawnEcho>& drawn = aim.seen.drawn;
  if (drawn.empty()) return;
  std::vector<int64_t> paths;
  for (const DrawnEcho& echo : drawn) paths.push_back(echo.path);
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  replayer_.evaluate(paths, paths_.frame.start_time + radar_.chirp_time(chirp.tx, aim.chirp), lengths, amplitudes, job);
  const size_t first = static_cast<size_t>(aim.channel) * paths.size();
  const double wavenumber = kTwoPi * radar_.waveform.start_frequency / kSpeedOfLight;
  double power = 0.0, of_phase = 0.0, of_amplitude = 0.0;
  for (size_t i = 0; i < paths.size(); ++i) {
    const std::complex<double> exact = amplitudes[first + i];
    power += std::norm(exact);
    of_amplitude += std::norm(drawn[i].amplitude - exact);
    if (exact == 0.0) continue;
    const double phase = wavenumber * std::abs(kSpeedOfLight * drawn[i].delay - lengths[first + i]);
    of_phase += std::norm(exact) * phase * phase;
    chirp.largest_phase_error = std::max(chirp.largest_phase_error, phase);
  }
  chirp.num_echoes = static_cast<int64_t>(paths.size());
  if (power > 0.0) {
    chirp.phase_error = std::sqrt(of_phase / power);
    chirp.amplitude_error = std::sqrt(of_amplitude / power);
  } else if (of_amplitude > 0.0) {
    chirp.amplitude_error = 1.0;
  }
}

}  // namespace echopath
