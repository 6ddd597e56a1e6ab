#include "results/checkpoints/part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "results/checkpoints/part_content.hpp"
#include "results/disk/checksum.hpp"
#include "results/disk/error.hpp"
#include "results/disk/input_file.hpp"
#include "results/disk/names.hpp"
#include "results/disk/publish.hpp"

namespace jostle::inline results {
namespace {

constexpr std::string_view magic = "jostle part\n";
constexpr std::uint32_t state_number = 0xffffffff;
constexpr std::size_t sum_size = std::tuple_size_v<Sha256::Sum>;

void write_part(const std::string& path, const PartIdentity& identity, std::uint32_t number,
                ByteWriter& content) {
  ByteWriter part;
  for (const char c : magic) part.put(c);
  part.put(part_format);
  part.put(identity.run_id);
  part.put(identity.id.point);
  part.put(identity.id.realization);
  part.put(number);
  part.put<std::uint64_t>(content.bytes().size());
  auto& bytes = part.bytes();
  bytes.insert(bytes.end(), content.bytes().begin(), content.bytes().end());
  const auto sum = sha256(bytes);
  bytes.insert(bytes.end(), sum.begin(), sum.end());
  publish(path, bytes);
}

void check_sum(const std::string& path, std::span<const std::byte> bytes) {
  if (bytes.size() < magic.size() + sum_size)
    throw ResultsError(path, "truncated part; delete it to lose what it held, or restore it");
  if (!std::equal(magic.begin(), magic.end(), reinterpret_cast<const char*>(bytes.data())))
    throw ResultsError(path, "not a part of a jostle run");
  const auto sum = sha256(bytes.first(bytes.size() - sum_size));
  if (!std::equal(sum.begin(), sum.end(), bytes.end() - sum_size))
    throw ResultsError(path,
                       "truncated or damaged part (its checksum is wrong); delete it to lose what "
                       "it held, or restore it");
}

/// Verifies a part and returns the reader of its content.
ByteReader open_part(const std::string& path, std::span<const std::byte> bytes,
                     const PartIdentity& identity, std::uint32_t number) {
  check_sum(path, bytes);
  ByteReader reader(bytes.first(bytes.size() - sum_size));
  for (std::size_t i = 0; i < magic.size(); ++i) reader.get<char>();
  if (const auto version = reader.get<std::uint32_t>(); version != part_format)
    throw ResultsError(path, fmt::format("part of format {}, but this jostle reads format {}",
                                         version, part_format));
  if (reader.get_string() != identity.run_id) throw ResultsError(path, "part of another run");
  RealizationId id;
  id.point = reader.get<std::uint32_t>();
  id.realization = reader.get<std::uint32_t>();
  if (id != identity.id || reader.get<std::uint32_t>() != number)
    throw ResultsError(path, "part of another realization or another segment: was it renamed?");
  reader.get<std::uint64_t>();
  return reader;
}

template <class Content>
Content read_part(InputFile& file, const std::string& path, const PartIdentity& identity,
                  std::uint32_t number, Content (*get)(ByteReader&)) {
  const std::vector<std::byte> bytes = read_bytes(file);
  try {
    ByteReader reader = open_part(path, bytes, identity, number);
    return get(reader);
  } catch (const std::out_of_range&) {
    throw ResultsError(path, "malformed part");
  }
}

}  // namespace

std::string parts_folder(const std::string& results_path) {
  return path_with_ending(results_path, ".parts");
}

std::string state_path(const std::string& results_path, RealizationId id) {
  return fmt::format("{}/p{:04}_r{:05}.state", parts_folder(results_path), id.point,
                     id.realization);
}

std::string segment_path(const std::string& results_path, RealizationId id, std::uint32_t number) {
  return fmt::format("{}/p{:04}_r{:05}.segment{:05}", parts_folder(results_path), id.point,
                     id.realization, number);
}

void write_state(const std::string& path, const PartIdentity& identity, const PartState& state) {
  ByteWriter content;
  put(content, state);
  write_part(path, identity, state_number, content);
}

void write_segment(const std::string& path, const PartIdentity& identity, std::uint32_t number,
                   const SeriesPiece& piece) {
  ByteWriter content;
  put(content, piece);
  write_part(path, identity, number, content);
}

PartState read_state(const std::string& path, const PartIdentity& identity) {
  InputFile file(path);
  return read_part(file, path, identity, state_number, get_part_state);
}

PartOutline read_state_outline(const std::string& path, const PartIdentity& identity) {
  InputFile file(path);
  PartOutline outline = read_part(file, path, identity, state_number, get_part_outline);
  outline.stamp = file.stamp();
  return outline;
}

PiecePlaces read_segment_places(const std::string& path, const PartIdentity& identity,
                                std::uint32_t number) {
  InputFile file(path);
  return read_part(file, path, identity, number, get_piece_places);
}

}  // namespace jostle::inline results
