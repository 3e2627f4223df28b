#pragma once
// Evaluates the echoes of pieces of sharp edges (em/edges/edge_diffraction.h) at the nodes of a time grid.
//
//   a = sqrt(Pt Gt Gr)/(4 pi) * weight * (e_r . M e_t) dl F / (2 k r_t r_r),   F = edge_filter(k (u - s).dl, b)
//
// b is the quadratic phase of the wave fronts over the piece.
//
// Where the path goes on from edge to edge (em/edges/multiple_diffraction.h), M is what multiple diffraction makes of the
// field, u the direction in which it arrives at the last edge, dl the piece of that edge, and the lengths include the way
// over the faces. Otherwise dl is the piece at that time, r_t and r_r are the unfolded lengths of the legs to both antennas,
// u and s are the directions in which the wave arrives at the edge and leaves it, and M is the fringe_matrix of its faces.
// e_t and e_r are the polarisations of both antennas across these directions, as they have come over the mirrors between: in
// a polarised trace by the coefficients that the materials have at that time. In the scalar model the coefficients are those
// of the trace, in the weight, and the receiver has the polarisation of the transmitter. Sheets on the way pass, in a
// polarised trace, both modes of each antenna's own field; in the scalar model they are no part of this (sheet_passages.h).
#include "echopath/replay/evaluate/shared_legs.h"
#include "echopath/replay/factors/path_passages.h"

namespace echopath {

// Writes the edge paths of the plan, of the record whose sheets these are; without their amplitudes where these are not
// wanted.
void evaluate_edges(const SharedLegPlan& plan, const RecordSheets& sheets, const PosedNodes& nodes,
                    const RadioConstants& radio, const ChannelSpan& channels, bool with_amplitudes);

}  // namespace echopath
