#include "ensemble/result_bytes.hpp"

namespace carom {

namespace {

void write_common(BytesOut& out, const EnsembleResult& sum) {
  out << sum.digest << sum.decisions << sum.cpu_seconds << sum.done.ranges()
      << std::uint64_t{sum.reports.size()};
  for (const auto& [index, text] : sum.reports) out << index << text;
}

void read_common(BytesIn& in, EnsembleResult& sum) {
  std::vector<TrajectoryRange> done;
  std::uint64_t count = 0;
  in >> sum.digest >> sum.decisions >> sum.cpu_seconds >> done >> count;
  for (const TrajectoryRange& range : done) sum.done.add(range);
  for (std::uint64_t i = 0; i < count; ++i) {
    auto& [index, text] = sum.reports.emplace_back();
    in >> index >> text;
  }
}

// Of a result that may be const or not.
template <class Counts>
auto numbers_of(Counts& c) {
  return std::vector{&c.trajectories, &c.escaped, &c.survived,   &c.pinned,   &c.capped,   &c.singular,
                     &c.unbounded,    &c.lost,    &c.collisions, &c.contacts, &c.most_hits};
}

}  // namespace

void write_bytes(BytesOut& out, const std::vector<RecordBlock>& blocks) {
  out << std::uint64_t{blocks.size()};
  for (const RecordBlock& block : blocks) out << block.range << block.records;
}

void read_bytes(BytesIn& in, std::vector<RecordBlock>& blocks) {
  std::uint64_t count = 0;
  in >> count;
  for (std::uint64_t i = 0; i < count; ++i) {
    RecordBlock& block = blocks.emplace_back();
    in >> block.range >> block.records;
  }
}

void write_bytes(BytesOut& out, const EscapeResult& sum) {
  write_common(out, sum);
  out << sum.counts.times << sum.counts.gone_in << sum.counts.gone_in_hits << sum.counts.hole_escapes
      << sum.effort;
  for (const std::uint64_t* number : numbers_of(sum.counts)) out << *number;
}

void read_bytes(BytesIn& in, EscapeResult& sum) {
  read_common(in, sum);
  in >> sum.counts.times >> sum.counts.gone_in >> sum.counts.gone_in_hits >> sum.counts.hole_escapes >>
      sum.effort;
  for (std::uint64_t* number : numbers_of(sum.counts)) in >> *number;
}

}  // namespace carom
