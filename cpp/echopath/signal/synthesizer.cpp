#include "echopath/signal/synthesizer.h"

#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/signal/echoes/echoes_check.h"
#include "echopath/signal/kernels/carrier.h"
#include "echopath/signal/methods/method.h"
#include "echopath/signal/methods/per_sample.h"
#include "echopath/signal/row_memory.h"

namespace echopath {
namespace {

constexpr int64_t kRecurrenceLimit = 40;  // echoes below which the recurrence beats the FFT of a NUFFT row

Method choose_method(Method asked, int64_t expected_echoes) {
  if (asked != Method::kAuto) return asked;
  return expected_echoes < kRecurrenceLimit ? Method::kRecurrence : Method::kNufft;
}

bool same_sampling(const TimeSampling& a, const TimeSampling& b) {
  return a.num_rows == b.num_rows && a.order == b.order && a.first_row == b.first_row && a.value == b.value &&
         a.slope == b.slope && a.rows == b.rows;
}

// Returns how many blocks from the first on share its sampling.
size_t run_of_one_sampling(std::span<const Echoes> blocks) {
  size_t count = 1;
  while (count < blocks.size() && same_sampling(blocks[count].sampling, blocks.front().sampling)) ++count;
  return count;
}

}  // namespace

Synthesizer::Synthesizer(const ChirpSequence& waveform, int num_channels, int num_groups, int64_t expected_echoes,
                         const SynthesisOptions& options)
    : waveform_(waveform), num_groups_(num_groups), method_(choose_method(options.method, expected_echoes)) {
  waveform.validate();
  require(num_channels >= 1, "num_channels", "must be at least 1", num_channels);
  require(num_groups >= 1, "num_groups", "must be at least 1", num_groups);
  require(expected_echoes >= 0, "expected_echoes", "must not be negative", expected_echoes);
  require(options.tolerance >= 1e-13 && options.tolerance <= 0.1, "tolerance", "must be in [1e-13, 0.1]", options.tolerance);
  if (method_ == Method::kNufft) {
    const auto nufft = make_nufft(waveform.num_samples, options.tolerance);
    spread_ = options.per_sample ? nullptr : nufft.get();
    tones_ = nufft;
  } else {
    tones_ = method_ == Method::kDirect ? make_direct(waveform.num_samples) : make_recurrence(waveform.num_samples);
  }
  model_ = std::make_unique<CarrierModel>(waveform, tones_->reference_sample());
  if (options.per_sample) {
    sample_rows_ = make_direct(waveform.num_samples);
    per_sample_ = std::make_unique<PerSample>(waveform, *model_);
  }
  const auto groups = static_cast<size_t>(num_groups);
  for (int channel = 0; channel < num_channels; ++channel) {
    channels_.push_back({std::vector<std::unique_ptr<RowMemory>>(groups), std::vector<std::vector<double>>(groups)});
  }
}

Synthesizer::~Synthesizer() {
  KeptMemory& kept = KeptMemory::of_process();
  for (ChannelRows& channel : channels_) {
    for (std::unique_ptr<RowMemory>& rows : channel.moving) kept.leave(std::move(rows));
  }
  for (std::unique_ptr<RowBands>& bands : bands_) kept.leave(std::move(bands));
  leave_scratch();
}
Synthesizer::Synthesizer(Synthesizer&&) noexcept = default;

void Synthesizer::leave_scratch() { KeptMemory::of_process().leave(std::move(tiles_)); }

// Returns the number of doubles of one row, both parts.
int64_t Synthesizer::row_size(bool moving) const {
  return 2 * (moving && sample_rows_ ? sample_rows_ : tones_)->row_length();
}

void Synthesizer::add(int channel, std::span<const Echoes> blocks, Job* job) {
  require_channel(channel);
  parallel_for(std::ssize(blocks), [&](int64_t i) { require_echoes(blocks[i], waveform_.num_chirps, num_groups_); });
  while (!blocks.empty()) {
    const std::span<const Echoes> run = blocks.first(run_of_one_sampling(blocks));
    if (run.front().sampling.is_static()) {
      add_still(run, channels_[channel], job);
    } else {
      add_moving(run, channel, job);
    }
    if (job) {
      for (const Echoes& block : run) job->advance(block.num_echoes);
    }
    blocks = blocks.subspan(run.size());
  }
}

}  // namespace echopath
