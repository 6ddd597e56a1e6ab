#include "results/run/merge_inputs.hpp"

#include <algorithm>

namespace jostle::inline results {
namespace {

constexpr std::size_t most_open = 64;

/// Reads by way of the inputs, which open its file where it rests.
class Input : public StoredRealization {
 public:
  Input(MergeInputs& inputs, std::size_t number, std::unique_ptr<StoredRealization> stored)
      : inputs_(inputs), number_(number), stored_(std::move(stored)) {}

  const void* source() const override { return &inputs_.files()[number_]; }
  RealizationHead head() override { return stored().head(); }
  std::uint64_t n_rows() const override { return stored().n_rows(); }
  void read_rows(std::uint64_t first, std::span<double> rows) override {
    stored().read_rows(first, rows);
  }
  std::vector<SnapshotOutline> snapshots() override { return stored().snapshots(); }
  std::vector<Vec3> vectors(std::uint64_t tap, std::size_t index) override {
    return stored().vectors(tap, index);
  }
  std::vector<double> profile(std::uint64_t tap, std::size_t index) override {
    return stored().profile(tap, index);
  }
  std::vector<Contact> contacts(std::uint64_t tap) override { return stored().contacts(tap); }

 private:
  StoredRealization& stored() const {
    inputs_.open(number_);
    return *stored_;
  }

  MergeInputs& inputs_;
  std::size_t number_;
  std::unique_ptr<StoredRealization> stored_;
};

}  // namespace

MergeInputs::MergeInputs(std::span<const std::string> paths) {
  for (const std::string& path : paths) {
    if (files_.empty())
      files_.emplace_back(path);
    else
      files_.emplace_back(path, Verify::whole_file, files_.front());
    open(files_.size() - 1);
  }
}

const ResultsFile& MergeInputs::open(std::size_t number) {
  if (!open_.empty() && open_.front() == number) return files_[number];
  if (!open_.empty()) files_[open_.front()].forget_rows();
  const auto found = std::ranges::find(open_, number);
  if (found != open_.end())
    open_.splice(open_.begin(), open_, found);
  else
    open_.push_front(number);
  if (open_.size() > most_open) {
    files_[open_.back()].rest();
    open_.pop_back();
  }
  return files_[number];
}

std::unique_ptr<StoredRealization> MergeInputs::realization(std::size_t number, RealizationId id) {
  return std::make_unique<Input>(*this, number, open(number).realization(id));
}

}  // namespace jostle::inline results
