#pragma once
// The settings of a record (RecordSettings) as Python knows them: the one list of what `trace`, `LiveTrace.update` and
// `TraceFrame` take by keyword.
#include "call/argument.h"
#include "echopath/record/paths.h"
#include "values/choice.h"
#include "values/keywords.h"

namespace echopath::bindings {

using RecordKeywords = ListOfKeywords<
    RecordSettings, Keyword<"seed", &RecordSettings::seed, Seed, "of directions and random phases">,
    Keyword<"max_bounces", &RecordSettings::max_bounces, Count, "hits of a path at most">,
    Keyword<"polarization", &RecordSettings::polarization, OneOf<kPolarization>, "\"scalar\" or \"jones\"">,
    Keyword<"footprint", &RecordSettings::footprint, OneOf<kFootprint>,
            "\"second_order\", \"edges\", \"first_order\" or \"none\"">,
    Keyword<"sampler", &RecordSettings::sampler, OneOf<kSampler>, "\"lattice\", \"fibonacci\", \"r2\" or \"random\"">,
    Keyword<"num_batches", &RecordSettings::batches, Count, "independent parts of the rays">,
    Keyword<"scatterers", &RecordSettings::scatterers, OneOf<kScatterers>,
            "\"rays\" or \"surface\": what the scatterers of rough surfaces are">,
    Keyword<"edges", &RecordSettings::edges, Flag, "whether echoes of sharp edges were looked for">,
    Keyword<"attenuation", &RecordSettings::attenuation, Real, "Np/m of fields in the air, along every path">,
    Keyword<"faint_power", &RecordSettings::faint_power, Real,
            "W, below which some of the diffuse paths were kept for all of them; 0: all were">>;

static_assert(RecordKeywords::is_whole(), "each member of RecordSettings needs its line in RecordKeywords");

}  // namespace echopath::bindings
