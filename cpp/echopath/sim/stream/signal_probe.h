#pragma once
// Spot-checks a pass of replay and synthesis: it computes a few samples of a few chirps as direct sums of all echoes, and
// evaluates a few of these at the chirp instead of between nodes.
#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "echopath/signal/kernels/carrier.h"
#include "echopath/signal/synthesizer.h"
#include "echopath/sim/stream/replay_stream.h"

namespace echopath {

// Holds what some of the rays contribute to one chirp. Paths of rough surfaces, whose phases are random, count by their
// power.
struct RayShare {
  static constexpr int kSamples = 8;
  std::array<std::complex<double>, kSamples> field{};  // sqrt(W), sums over coherent paths at the samples drawn
  double power = 0.0;                                  // W, sum of |amplitude|^2 of the others
};

// Describes one chirp of one channel of the frame.
struct ProbedChirp {
  static constexpr int kSamples = RayShare::kSamples;
  int tx = 0, rx = 0, chirp = 0;
  std::array<int, kSamples> sample{};
  std::array<std::complex<double>, kSamples> value{};  // sqrt(W): direct sums over the echoes as replayed
  double amplitude_sum = 0.0;                          // sqrt(W), sum of |amplitude| of all echoes in this chirp
  // This counts the moving echoes that were evaluated at the chirp, too: the strongest and random ones of each block of
  // paths.
  int64_t num_echoes = 0;
  double phase_error = 0.0;          // rad at the start frequency, rms weighted by the power of the echoes
  double largest_phase_error = 0.0;  // rad
  double amplitude_error = 0.0;  // rms of the differences over rms of the largest amplitudes of these echoes in the frame
  double compared_power = 0.0;   // W, sum of |amplitude|^2 of these echoes
  double strongest_power = 0.0;  // W, of their largest in the frame, and no less than what could be heard
  // These are the shares of halves 0 and 1 (half_of_ray) of the rays of each batch in turn, and last of the image method's
  // paths: 2 batches + 1.
  std::vector<RayShare> shares;
  double power_sum = 0.0;  // W, of |amplitude|^2 of all paths
  double strongest = 0.0;  // W, of the strongest path that rays found

  // Adds the same chirp and samples of another record, whose echoes add up with these. Errors count by the power compared,
  // so that those of a record with hardly any power do not stand for all.
  void add(const ProbedChirp& other);
};

// Collects what passes find. Chirps and samples are drawn by `seed`.
struct SignalProbe {
  uint64_t seed = 1;
  int first_chirp = 0;  // chirp of the frame with which the next pass begins
  std::vector<ProbedChirp> chirps;
};

class StrongestEchoes;
class TonesOfRows;

// Probes the echoes of one pass at one chirp, or at two where there are several channels. TARGET of
// python/echopath/bench/speed/guard.py bounds its share of the time of trace and synthesis of one channel; more channels
// cost less. The result has the same bits for any number of threads.
class PassProbe : public PathWatcher {
 public:
  // All arguments must outlive it.
  PassProbe(const Paths& paths, const Radar& radar, const Replayer& replayer, const SynthesisOptions& synthesis,
            const SignalProbe& probe);
  ~PassProbe() override;
  bool watches(int channel) const override;
  void see(int channel, size_t block, const Echoes& echoes, std::span<const int64_t> paths) override;
  void end_blocks() override;
  // Evaluates the echoes drawn and adds the chirps to `probe`. Raises Cancelled.
  void finish(SignalProbe& probe, Job* job);

 private:
  struct ChirpTarget;
  struct EchoTally;
  void tally_block(const ChirpTarget& target, const Echoes& block, std::span<const int64_t> paths, EchoTally& tally) const;
  static void draw_samples(uint64_t seed, int64_t index, int num_samples, ChirpTarget& target);
  size_t num_shares() const;
  void sort_paths(std::span<const int64_t> paths, const double* power, uint32_t* row, EchoTally& tally) const;
  void add_samples(const ChirpTarget& target, const Echoes& block, int64_t begin, const EchoStates& states,
                   std::span<const uint32_t> row, TonesOfRows& tones, EchoTally& tally) const;
  void sum_up(const ChirpTarget& target, ProbedChirp& chirp) const;
  void draw_echoes(const ChirpTarget& target, const Echoes& block, std::span<const int64_t> paths,
                   const StrongestEchoes& strongest, EchoTally& tally) const;
  void compare_echoes(const ChirpTarget& target, ProbedChirp& chirp, Job* job) const;
  static void add(const EchoTally& some, EchoTally& all);

  const Paths& paths_;
  const Radar& radar_;
  const Replayer& replayer_;
  CarrierModel model_;
  std::unique_ptr<const PerSample> per_sample_;
  uint64_t seed_;
  std::vector<ChirpTarget> targets_;
};

}  // namespace echopath
