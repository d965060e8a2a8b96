#include "ensemble/crew.hpp"

#include <chrono>
#include <utility>

#include "carom/base/error.hpp"
#include "ensemble/bytes.hpp"

namespace carom {

namespace {

// To the foreman: ask, part. To the others: plan, blocks, stop.
enum class Kind : std::uint8_t { ask, part, plan, blocks, stop };

// Between looks for messages: short beside a block, long beside a look.
constexpr auto pause = std::chrono::microseconds(500);

BytesOut message(Kind kind) {
  BytesOut out;
  out << kind;
  return out;
}

void write(BytesOut& out, const EscapePart& part) {
  const EscapeResult& sum = part.sum;
  const SurvivalCounts& c = sum.counts;
  out << c.times << c.gone_in << c.gone_in_hits << c.hole_escapes;
  for (const std::uint64_t n : {c.trajectories, c.escaped, c.survived, c.pinned, c.capped, c.singular, c.unbounded,
                                c.lost, c.collisions, c.contacts, c.most_hits, sum.digest})
    out << n;
  out << sum.decisions << sum.effort << sum.cpu_seconds << sum.done.ranges();
  out << std::uint64_t{sum.reports.size()};
  for (const auto& [index, text] : sum.reports) out << index << text;
  out << std::uint64_t{part.blocks.size()};
  for (const EscapePart::Block& block : part.blocks) out << block.range << block.records;
}

EscapePart read_part(BytesIn& in) {
  EscapePart part;
  EscapeResult& sum = part.sum;
  SurvivalCounts& c = sum.counts;
  in >> c.times >> c.gone_in >> c.gone_in_hits >> c.hole_escapes;
  for (std::uint64_t* n : {&c.trajectories, &c.escaped, &c.survived, &c.pinned, &c.capped, &c.singular, &c.unbounded,
                           &c.lost, &c.collisions, &c.contacts, &c.most_hits, &sum.digest})
    in >> *n;
  std::vector<TrajectoryRange> done;
  in >> sum.decisions >> sum.effort >> sum.cpu_seconds >> done;
  for (const TrajectoryRange& range : done) sum.done.add(range);
  std::uint64_t count = 0;
  in >> count;
  for (std::uint64_t i = 0; i < count; ++i) {
    auto& [index, text] = sum.reports.emplace_back();
    in >> index >> text;
  }
  in >> count;
  for (std::uint64_t i = 0; i < count; ++i) {
    EscapePart::Block& block = part.blocks.emplace_back();
    in >> block.range >> block.records;
  }
  return part;
}

}  // namespace

Foreman::Foreman(Ranks& ranks, const CrewPlan& plan, Calls calls)
    : ranks_(ranks), plan_(plan), calls_(std::move(calls)), left_(ranks.size() - 1), told_(static_cast<std::size_t>(ranks.size()), 0) {
  for (int rank = 1; rank < ranks_.size(); ++rank) {
    BytesOut out = message(Kind::plan);
    out << plan_.records << plan_.seconds;
    ranks_.send(rank, out.bytes);
  }
  thread_ = std::thread([this] { serve(); });
}

void Foreman::dismiss(Ranks& ranks) {
  for (int rank = 1; rank < ranks.size(); ++rank) ranks.send(rank, message(Kind::stop).bytes);
}

Foreman::~Foreman() {
  failed_ = true;  // where an exception is on its way
  if (thread_.joinable()) thread_.join();
}

void Foreman::wait() {
  thread_.join();
  if (!error_.empty()) throw InputError(error_);
}

void Foreman::serve() {
  while (left_ > 0) {
    if (failed_ || calls_.stopped())
      for (int rank = 1; rank < ranks_.size(); ++rank) stop(rank);
    const auto incoming = ranks_.receive();
    if (incoming)
      answer(*incoming);
    else
      std::this_thread::sleep_for(pause);
  }
}

// Everybody is told once, at the latest when it has ended: so no message is left behind.
void Foreman::stop(int rank) {
  if (std::exchange(told_[static_cast<std::size_t>(rank)], char{1})) return;
  ranks_.send(rank, message(Kind::stop).bytes);
}

void Foreman::answer(const Ranks::Message& incoming) {
  BytesIn in(incoming.bytes);
  Kind kind{};
  in >> kind;
  if (kind == Kind::ask) {
    BytesOut out = message(Kind::blocks);
    out << calls_.blocks(8 * static_cast<std::uint64_t>(ranks_.size())) << calls_.block;
    ranks_.send(incoming.from, out.bytes);
    return;
  }
  bool last = false, stopped = false;
  std::string error;
  in >> last >> stopped >> error;
  if (last) {
    --left_;
    stop(incoming.from);
  }
  if (stopped || !error.empty()) failed_ = true;
  if (error_.empty() && !error.empty()) error_ = error;
  try {
    calls_.take(read_part(in));
  } catch (const std::exception& problem) {
    failed_ = true;
    if (error_.empty()) error_ = problem.what();
  }
}

Hand::Hand(Ranks& ranks) : ranks_(ranks) {
  for (;;) {
    if (const auto incoming = ranks_.receive()) {
      BytesIn in(incoming->bytes);
      Kind kind{};
      in >> kind;
      if (kind == Kind::plan) in >> plan_.records >> plan_.seconds;
      if (kind == Kind::stop) stopped_ = true;
      if (kind == Kind::plan || kind == Kind::stop) return;
    }
    std::this_thread::sleep_for(pause);
  }
}

Hand::~Hand() {
  if (thread_.joinable()) end("a rank ended early");
}

void Hand::start(Calls calls, const std::atomic<bool>* interrupted) {
  calls_ = std::move(calls);
  interrupted_ = interrupted;
  thread_ = std::thread([this] { serve(); });
}

bool Hand::next(TrajectoryRange& block) {
  std::unique_lock lock(mutex_);
  more_.wait(lock, [this] { return stopped_ || exhausted_ || (stock_ && used_ < stock_->size()); });
  if (stopped_ || !stock_ || used_ >= stock_->size()) return false;
  block = (*stock_)[used_++];
  return true;
}

void Hand::end(const std::string& error) {
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;
    ended_ = true;
    error_ = error;
  }
  if (thread_.joinable()) thread_.join();
}

void Hand::tell(bool last, const std::string& error) {
  BytesOut out = message(Kind::part);
  const bool interrupted = interrupted_ && *interrupted_;
  out << last << interrupted << error;
  write(out, calls_.take());
  ranks_.send(0, out.bytes);
}

void Hand::read(const Ranks::Message& incoming) {
  BytesIn in(incoming.bytes);
  Kind kind{};
  in >> kind;
  const std::lock_guard lock(mutex_);
  if (kind == Kind::stop) stopped_ = true;
  if (kind == Kind::blocks) {
    std::vector<TrajectoryRange> ranges;
    std::uint64_t size = 1;
    in >> ranges >> size;
    asked_ = false;
    if (ranges.empty()) {
      exhausted_ = true;
    } else {
      // What is left of the last ones goes first.
      std::vector<TrajectoryRange> all;
      for (; stock_ && used_ < stock_->size(); ++used_) all.push_back((*stock_)[used_]);
      all.insert(all.end(), ranges.begin(), ranges.end());
      stock_.emplace(std::move(all), size);
      used_ = 0;
    }
  }
  more_.notify_all();
}

void Hand::serve() {
  auto told = std::chrono::steady_clock::now();
  const std::chrono::duration<double> between(plan_.seconds);
  for (;;) {
    const auto incoming = ranks_.receive();
    if (incoming) read(*incoming);
    bool ask = false, last = false;
    {
      const std::lock_guard lock(mutex_);
      last = ended_;
      const bool low = !stock_ || 2 * used_ >= stock_->size();
      ask = !ended_ && !asked_ && !exhausted_ && !stopped_ && low;
      if (ask) asked_ = true;
    }
    if (last) break;
    if (ask) ranks_.send(0, message(Kind::ask).bytes);
    const auto now = std::chrono::steady_clock::now();
    if (now - told > between || calls_.heavy()) {
      tell(false, "");
      told = now;
    }
    if (!incoming) std::this_thread::sleep_for(pause);
  }
  tell(true, error_);
  while (asked_ || !stopped_) {
    if (const auto incoming = ranks_.receive())
      read(*incoming);
    else
      std::this_thread::sleep_for(pause);
  }
}

}  // namespace carom
