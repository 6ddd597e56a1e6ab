#pragma once

#include "engine/bytes.hpp"
#include "results/checkpoints/part.hpp"

// The bytes inside parts.
namespace jostle::inline results {

void put(ByteWriter& writer, const SeriesPiece& piece);
void put(ByteWriter& writer, const PartState& part);
/// Throw std::out_of_range where the bytes end too early.
SeriesPiece get_piece(ByteReader& reader);
PartState get_part_state(ByteReader& reader);
/// Places from the beginning of the bytes.
PiecePlaces get_piece_places(ByteReader& reader);
PartOutline get_part_outline(ByteReader& reader);

}  // namespace jostle::inline results
