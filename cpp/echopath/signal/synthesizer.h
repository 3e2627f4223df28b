#pragma once
// IF synthesis turns delays and amplitudes of echoes into samples of every chirp, channel and group.
#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/radar/radar.h"
#include "echopath/signal/echoes/echo_tiles.h"
#include "echopath/signal/echoes/echoes.h"
#include "echopath/signal/echoes/row_bands.h"

namespace echopath {

class PerSample;
class SpreadMethod;
class ToneMethod;
struct CarrierModel;
struct Rows;

enum class Method { kAuto, kDirect, kRecurrence, kNufft };

struct SynthesisOptions {
  double tolerance = 1e-7;        // rms error over the samples, relative to the sum of |amplitude|; 1e-13 to 0.1
  Method method = Method::kAuto;  // kAuto: recurrence for few echoes, else NUFFT; kDirect is the reference
  // Takes moving echoes with the delay of every sample (per_sample.h), whatever the method; costs a sine and cosine per
  // sample.
  bool per_sample = false;
};

// Adds echoes block by block. Model: carrier.h ("lin", residual video phase included, brick-wall anti-alias filter at
// the sampling rate, or half of it for real samples), or per_sample.h for what moves.
// Linear: the cubes of the groups add up to the cube of the whole (to rounding), because the method is chosen once
// from the number of echoes of the whole set, whatever the groups. The same blocks in the same order give the same
// bits for any number of threads. Echoes that do not move are added once, so a static scene gives bit-identical
// chirps.
// Memory: 16 bytes x channels x groups x chirps x samples (twice that for NUFFT, and of several groups only the cells of the
// grid near their echoes), only for groups with moving echoes, and what `add` says; it is left to KeptMemory for the next.
class Synthesizer {
 public:
  // `expected_echoes` counts the echoes of the whole set per channel. Raises invalid_argument on a bad waveform, count or
  // tolerance.
  Synthesizer(const ChirpSequence& waveform, int num_channels, int num_groups, int64_t expected_echoes,
              const SynthesisOptions& options = {});
  ~Synthesizer();
  Synthesizer(Synthesizer&&) noexcept;

  size_t group_bytes() const;                // of a group whose echoes move and are at all ranges, in all channels
  Method method() const { return method_; }  // the one chosen, never kAuto

  // Adds blocks to a channel; parallel over chirps. It is quicker to add many echoes at once: a NUFFT sorts neighbouring
  // moving blocks of one sampling together, which needs as much memory again as they have. Raises invalid_argument on
  // wrong shapes, groups out of range, or values that are not finite; nothing is added then. The job's progress advances
  // by the number of echoes. Raises Cancelled when the job is cancelled; the cubes are void then.
  void add(int channel, std::span<const Echoes> blocks, Job* job = nullptr);
  void add(int channel, const Echoes& block, Job* job = nullptr) { add(channel, std::span(&block, 1), job); }

  // Returns whether echoes were added to a channel and group.
  bool has_echoes(int channel, int group) const;
  // Returns whether echoes that do not move were added to them.
  bool has_still(int channel, int group) const;
  // Returns whether no moving echoes were added to them, so that all chirps are the same.
  bool is_still(int channel, int group) const;
  // Writes the samples of one channel and some groups together, so far, to `out`, [chirp, sample] in sqrt(W), without a
  // parallel loop.
  void write_samples(int channel, std::span<const int> groups, std::complex<double>* out) const;
  // Adds the samples of what rests in one channel and some groups together, which are those of every chirp, to `out`,
  // [sample] in sqrt(W).
  void add_still_samples(int channel, std::span<const int> groups, std::complex<double>* out) const;
  // Returns the method that spreads all echoes on grids, or null where another method is used. It lives as long as this.
  const SpreadMethod* spread() const { return spread_; }
  // Returns the cells of the grid that the moving echoes of a channel and group have filled in one chirp so far.
  RowCells moving_cells(int channel, int group, int chirp) const;
  // Adds the signals of the first groups of another, of the same waveform, channels, method and tolerance, to the first
  // group.
  void absorb(const Synthesizer& other, int num_groups);
  // Returns whether only the cells near the echoes of a group take memory, because echoes are spread on grids and there are
  // several groups.
  bool has_bands() const { return spread_ && num_groups_ > 1; }
  // Leaves the memory that only `add` needs to KeptMemory, which the next `add` takes again.
  void leave_scratch();
  // Returns the samples [channel, chirp, sample] of one group so far, in sqrt(W).
  std::vector<std::complex<double>> cube(int group = 0, Job* job = nullptr) const;

 private:
  struct RowMemory;
  struct ChannelRows {
    // [group], each [chirp, re/im, row length]; null until a moving echo of it comes, and where there are bands_
    std::vector<std::unique_ptr<RowMemory>> moving;
    std::vector<std::vector<double>> still;  // [group], each [re/im, row length], added to every chirp; empty likewise
  };
  using RowsOfGroups = std::vector<double*>;  // [group], null for a group without rows
  struct Range {
    int64_t begin, end;
  };
  void add_still(std::span<const Echoes> blocks, ChannelRows& rows, Job* job) const;
  void add_still_part(std::span<const Echoes> blocks, Range part, const RowsOfGroups& rows, Job* job) const;
  void add_moving(std::span<const Echoes> blocks, int channel, Job* job);
  void assign_tiles(std::span<const Echoes> blocks);
  void start_bands();
  int chirps_of_piece(int piece) const;
  template <class Add>
  void for_tiles(Range chirps, Job* job, const Add& add) const;
  void add_to_bands(const TimeSampling& sampling, int channel, Range chirps, Job* job);
  size_t band_row(int channel, int group) const;
  void add_tiles(const TimeSampling& sampling, Range chirps, const RowsOfGroups& rows, Job* job) const;
  void add_tile(const EchoTiles::Tile& tile, const TimeSampling& sampling, Range chirps, const RowRoom& room) const;
  void add_rows(const Echoes& block, Range echoes, Range chirps, const RowsOfGroups& rows, Job* job) const;
  void add_some(const Echoes& block, int chirp, int64_t begin, int count, Rows rows) const;
  void require_channel(int channel) const;
  void require_group(int group) const;
  int64_t row_size(bool moving) const;
  double longest_delay() const;
  const double* moving_row(int channel, int group, int chirp, std::vector<double>& room) const;
  void write_row(const double* row, bool moving, std::complex<double>* out) const;
  void write_channel(int channel, int group, std::complex<double>* out, Job* job) const;
  void absorb_group(const Synthesizer& other, int channel, int group);
  void add_moving_row(int channel, int group, int chirp, double* row) const;

  ChirpSequence waveform_;
  int num_groups_;
  Method method_;
  std::shared_ptr<const ToneMethod> tones_;        // of all echoes, or of those at rest
  const SpreadMethod* spread_ = nullptr;           // tones_ where moving echoes go through tiles
  std::shared_ptr<const ToneMethod> sample_rows_;  // form of the rows of moving echoes, where there is a per_sample_
  std::unique_ptr<const PerSample> per_sample_;
  std::unique_ptr<const CarrierModel> model_;
  std::unique_ptr<EchoTiles> tiles_;  // null until moving echoes come
  std::vector<ChannelRows> channels_;
  // [chirp / chirps of a tile], of all channels and groups; there are none of a single group, or before moving echoes come
  std::vector<std::unique_ptr<RowBands>> bands_;
};

}  // namespace echopath
