// Results of ensembles as messages between processes.
#pragma once

#include <vector>

#include "carom/ensemble/diffusion.hpp"
#include "carom/ensemble/escape.hpp"
#include "ensemble/bytes.hpp"

namespace carom {

/// The records of trajectories that are done, on their way to a journal.
struct RecordBlock {
  TrajectoryRange range;
  std::vector<TrajectoryRecord> records;
};

void write_bytes(BytesOut&, const std::vector<RecordBlock>&);
void read_bytes(BytesIn&, std::vector<RecordBlock>&);

void write_bytes(BytesOut&, const EscapeResult&);
void read_bytes(BytesIn&, EscapeResult&);
inline std::uint64_t collisions_of(const EscapeResult& result) { return result.counts.collisions; }

void write_bytes(BytesOut&, const DiffusionResult&);
/// Into a result with the ensemble's times.
void read_bytes(BytesIn&, DiffusionResult&);
inline std::uint64_t collisions_of(const DiffusionResult& result) { return result.collisions; }

}  // namespace carom
