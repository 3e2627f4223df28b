#pragma once
// Puts what sheets do to the paths that go through them (Paths::passes) to lengths and amplitudes that are evaluated as if
// there were no sheets.
//
// The amplitude takes the transmission of the sheet (em/layers/sheet_model.h), and the length its delay: the phase of the
// transmission at the start frequency belongs to both together.
#include "echopath/replay/evaluate/shared_legs.h"
#include "echopath/replay/factors/path_passages.h"

namespace echopath {

class SheetPassages {
 public:
  // Serves the record of the preparer, which must outlive it, played back by this waveform. Raises invalid_argument.
  SheetPassages(const PathPreparer& preparer, const ChirpSequence& waveform) : sheets_(preparer, waveform) {}
  // Changes what was written for these paths, in the order of the places: lengths, and amplitudes where they were written.
  void apply(std::span<const int64_t> indices, const PosedNodes& nodes, const ChannelSpan& channels,
             bool with_amplitudes = true) const;
  const RecordSheets& sheets() const { return sheets_; }

 private:
  RecordSheets sheets_;
};

}  // namespace echopath
