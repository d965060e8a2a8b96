// A run as an outcome, with its rows.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "carom/analyses/run.hpp"
#include "carom/analyses/run/rows.hpp"
#include "cli/outcome.hpp"

namespace carom::cli {

/// Rows that were computed, or that an archive holds: those are read when they are asked for.
template <class Row>
class Rows {
 public:
  Rows() = default;
  Rows(std::shared_ptr<const std::vector<Row>> rows) : rows_(std::move(rows)) {}
  explicit Rows(std::function<std::vector<Row>()> read) : read_(std::move(read)) {}
  const std::shared_ptr<const std::vector<Row>>& get() const {
    if (!rows_) rows_ = std::make_shared<const std::vector<Row>>(read_());
    return rows_;
  }

 private:
  mutable std::shared_ptr<const std::vector<Row>> rows_;
  std::function<std::vector<Row>()> read_;
};

struct RunOutcome final : Outcome {
  using Outcome::Outcome;
  files::Json json() const override;
  std::string text() const override;
  std::vector<std::string> doubts() const override;
  void save(const std::string& file, bool force, const std::atomic<bool>& stop) const override;

  SingleRunResult result;
  std::string status;
  std::uint64_t trajectory = 0;
  Rows<HitRow> hits;
  Rows<SampleRow> samples;
  Rows<ContactRow> contacts;
  Rows<EnergyRow> energies;
  std::vector<SampleRow> starts;
};

}  // namespace carom::cli
