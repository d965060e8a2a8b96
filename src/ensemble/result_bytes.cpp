#include "ensemble/result_bytes.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "carom/base/error.hpp"

namespace carom {

namespace {

void write_common(BytesOut& out, const EnsembleResult& sum) {
  out << sum.digest << sum.decisions << sum.steps << sum.energy_error << sum.cpu_seconds << sum.done.ranges()
      << std::uint64_t{sum.reports.size()};
  for (const auto& [index, text] : sum.reports) out << index << text;
}

void read_common(BytesIn& in, EnsembleResult& sum) {
  std::vector<TrajectoryRange> done;
  std::uint64_t count = 0;
  in >> sum.digest >> sum.decisions >> sum.steps >> sum.energy_error >> sum.cpu_seconds >> done >> count;
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
                     &c.unbounded,    &c.unresolved, &c.lost,    &c.collisions, &c.contacts, &c.most_hits};
}

template <class Result>
auto diffusion_numbers_of(Result& r) {
  return std::vector{&r.trajectories, &r.survived, &r.pinned, &r.escaped, &r.singular, &r.unbounded,
                     &r.capped, &r.unresolved, &r.lost, &r.collisions};
}

// Most digits of a sum are zero: the others.
void write_sum(BytesOut& out, const ExactSum& sum) {
  const auto digits = sum.state();
  const auto is_something = [](std::int64_t digit) { return digit != 0; };
  const auto first = std::find_if(digits.begin(), digits.end(), is_something);
  const auto last = std::find_if(digits.rbegin(), std::make_reverse_iterator(first), is_something).base();
  out << static_cast<std::int32_t>(first - digits.begin()) << std::vector<std::int64_t>(first, last);
}

ExactSum read_sum(BytesIn& in) {
  std::int32_t first = 0;
  std::vector<std::int64_t> some;
  in >> first >> some;
  std::array<std::int64_t, ExactSum::digits> digits{};
  if (first < 0 || static_cast<std::size_t>(first) + some.size() > digits.size()) throw InternalError("a message holds no sum");
  std::copy(some.begin(), some.end(), digits.begin() + first);
  return ExactSum::from_state(digits);
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
      << sum.counts.energy_change << sum.effort;
  for (const std::uint64_t* number : numbers_of(sum.counts)) out << *number;
}

void read_bytes(BytesIn& in, EscapeResult& sum) {
  read_common(in, sum);
  in >> sum.counts.times >> sum.counts.gone_in >> sum.counts.gone_in_hits >> sum.counts.hole_escapes >>
      sum.counts.energy_change >> sum.effort;
  for (std::uint64_t* number : numbers_of(sum.counts)) in >> *number;
}

void write_bytes(BytesOut& out, const DiffusionResult& result) {
  write_common(out, result);
  for (const std::uint64_t* number : diffusion_numbers_of(result)) out << *number;
  out << result.energy_change;
  for (std::size_t group = 0; group < DisplacementSums::groups; ++group)
    for (std::size_t k = 0; k < result.sums.times().size(); ++k) {
      const DisplacementSums::Sum& sum = result.sums.of(group, k);
      out << sum.count;
      if (sum.count == 0) continue;
      write_sum(out, sum.square);
      write_sum(out, sum.fourth);
    }
}

void read_bytes(BytesIn& in, DiffusionResult& result) {
  read_common(in, result);
  for (std::uint64_t* number : diffusion_numbers_of(result)) in >> *number;
  in >> result.energy_change;
  for (std::size_t group = 0; group < DisplacementSums::groups; ++group)
    for (std::size_t k = 0; k < result.sums.times().size(); ++k) {
      DisplacementSums::Sum sum;
      in >> sum.count;
      if (sum.count == 0) continue;
      sum.square = read_sum(in);
      sum.fourth = read_sum(in);
      result.sums.merge(group, k, sum);
    }
}

}  // namespace carom
