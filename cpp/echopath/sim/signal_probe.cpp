#include "echopath/sim/signal_probe.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/parallel.h"
#include "echopath/base/random.h"
#include "echopath/base/simd.h"
#include "echopath/signal/carrier.h"
#include "echopath/signal/echo_states.h"
#include "echopath/signal/kernels.h"
#include "echopath/signal/per_sample.h"
#include "echopath/signal/phasor.h"

namespace echopath {
namespace {

constexpr int kSamples = ProbedChirp::kSamples;
constexpr int kChirps = 2;  // of a pass
constexpr size_t kStrongest = 4, kRandom = 4;  // echoes drawn of a block
constexpr size_t kEchoesOfChirp = 1024;        // that are evaluated, at most

// Sums of kSamples samples; also offsets of these in samples from the first of the chirp.
using SampleSums = std::array<double, kSamples>;

ECHOPATH_INLINE void add_tones(const Carriers* carriers, const double* sample, double* out_re, double* out_im) {
  SampleSums re{}, im{};
  for (int p = 0; p < carriers->count; ++p) {
    const double frequency = carriers->frequency[p], a = carriers->re[p], b = carriers->im[p];
    for (int s = 0; s < kSamples; ++s) {
      const Phasor phasor = phasor_of_cycles(frequency * sample[s]);
      re[s] += a * phasor.re - b * phasor.im;
      im[s] += a * phasor.im + b * phasor.re;
    }
  }
  for (int s = 0; s < kSamples; ++s) {
    out_re[s] += re[s];
    out_im[s] += im[s];
  }
}

// A number below `count` for the k-th draw of a pass that begins with a chirp of the frame.
int draw(uint64_t seed, int64_t index, int dimension, int count) {
  const double unit = uniform2(seed, Stream::kProbe, static_cast<uint64_t>(index), static_cast<uint32_t>(dimension))[0];
  return std::min(count - 1, static_cast<int>(unit * count));
}

ECHOPATH_INLINE void find_powers(const double* amplitude, int count, double* power, double* root) {
  for (int p = 0; p < count; ++p) {
    power[p] = amplitude[2 * p] * amplitude[2 * p] + amplitude[2 * p + 1] * amplitude[2 * p + 1];
    root[p] = std::sqrt(power[p]);
  }
}

// Of failed and of dark paths: 0 at all nodes.
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
  void show(const double* power, int64_t first, int count) {
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

// Of one block.
struct PassProbe::Seen {
  SampleSums re{}, im{};
  double amplitude_sum = 0.0;
  std::vector<DrawnEcho> drawn;
};

// A chirp of a channel, and what was seen of it so far.
struct PassProbe::Aim {
  int channel, chirp;
  SampleSums sample;
  Seen seen;
};

PassProbe::PassProbe(const Paths& paths, const Radar& radar, const Replayer& replayer, const SynthesisOptions& synthesis,
                     const SignalProbe& probe)
    : paths_(paths), radar_(radar), replayer_(replayer), model_(radar.waveform, 0), seed_(probe.seed) {
  if (synthesis.per_sample) per_sample_ = std::make_unique<PerSample>(radar.waveform, model_);
  for (int i = 0; i < kChirps; ++i) {
    const int64_t index = int64_t{probe.first_chirp} * kChirps + i;
    Aim& aim = aims_.emplace_back();
    aim.channel = draw(seed_, index, 0, replayer.num_channels());
    aim.chirp = draw(seed_, index, 1, radar.waveform.num_chirps);
    for (int s = 0; s < kSamples; ++s) {
      aim.sample[static_cast<size_t>(s)] = draw(seed_, index, 2 + s, radar.waveform.num_samples);
    }
  }
}

PassProbe::~PassProbe() = default;

void PassProbe::see(int channel, std::span<const Echoes> blocks, std::span<const int64_t> indices) {
  std::vector<std::span<const int64_t>> paths_of;
  for (const Echoes& block : blocks) {
    paths_of.push_back(indices.first(static_cast<size_t>(block.num_echoes)));
    indices = indices.subspan(paths_of.back().size());
  }
  for (Aim& aim : aims_) {
    if (aim.channel != channel) continue;
    std::vector<Seen> seen(blocks.size());
    parallel_for(static_cast<int64_t>(blocks.size()), [&](int64_t i) {
      const auto k = static_cast<size_t>(i);
      look(aim, blocks[k], paths_of[k], seen[k]);
    });
    for (const Seen& some : seen) add(some, aim.seen);
  }
}

void PassProbe::add(const Seen& some, Seen& all) {
  for (size_t s = 0; s < kSamples; ++s) {
    all.re[s] += some.re[s];
    all.im[s] += some.im[s];
  }
  all.amplitude_sum += some.amplitude_sum;
  all.drawn.insert(all.drawn.end(), some.drawn.begin(), some.drawn.end());
}

void PassProbe::look(const Aim& aim, const Echoes& block, std::span<const int64_t> paths, Seen& seen) const {
  constexpr int kCapacity = EchoStates::kCapacity;
  EchoStates states;
  alignas(64) double power[kCapacity], root[kCapacity];
  Strongest strongest;
  for (int64_t begin = 0; begin < block.num_echoes; begin += kCapacity) {
    const int count = static_cast<int>(std::min<int64_t>(kCapacity, block.num_echoes - begin));
    evaluate_states(block, aim.chirp, begin, count, states);
    run_simd<find_powers>(states.amplitude, count, power, root);
    seen.amplitude_sum = std::accumulate(root, root + count, seen.amplitude_sum);
    strongest.show(power, begin, count);
    add_samples(aim, block, begin, count, states, seen);
  }
  if (!block.sampling.is_static()) draw_echoes(aim, block, paths, strongest, seen);
}

void PassProbe::add_samples(const Aim& aim, const Echoes& block, int64_t begin, int count, const EchoStates& states,
                            Seen& seen) const {
  if (per_sample_ && !block.sampling.is_static()) {
    per_sample_->add_samples(block, aim.chirp, begin, count, aim.sample, seen.re, seen.im);
    return;
  }
  Carriers carriers;
  carriers.count = count;
  signal_kernels().modulate(model_, states, count, carriers);
  run_simd<add_tones>(&carriers, aim.sample.data(), seen.re.data(), seen.im.data());
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
    for (size_t s = 0; s < kSamples; ++s) {
      chirp.sample[s] = static_cast<int>(aim.sample[s]);
      chirp.value[s] = {aim.seen.re[s], aim.seen.im[s]};
      if (radar_.waveform.real) chirp.value[s] = std::numbers::sqrt2 * aim.seen.re[s];
    }
    thin_out(aim.seen.drawn);
    compare_echoes(aim, chirp, job);
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
