#include "ensemble/crew.hpp"

#include <chrono>
#include <new>
#include <utility>

#include "carom/base/error.hpp"

namespace carom {

namespace {

// To the foreman: ask, part. To the others: job, plan, blocks, stop.
enum class Kind : std::uint8_t { ask, part, job, plan, blocks, stop };
// Why all stop: there is nothing left to do, or somebody was interrupted; somebody failed.
enum class Why : std::uint8_t { done, failed };

// Between looks for messages: short beside a block, long beside a look.
constexpr auto pause = std::chrono::microseconds(500);

BytesOut message(Kind kind) {
  BytesOut out;
  out << kind;
  return out;
}

Ranks::Message next_message(Ranks& ranks) {
  for (;;) {
    if (auto incoming = ranks.receive()) return std::move(*incoming);
    std::this_thread::sleep_for(pause);
  }
}

void tell_others(Ranks& ranks, const BytesOut& out) {
  for (int rank = 1; rank < ranks.size(); ++rank) ranks.send(rank, out.bytes);
}

}  // namespace

std::string text_of(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) ? "out of memory" : error.what();
}

void call_crew(Ranks& ranks, const CrewJob* job) {
  BytesOut out = message(Kind::job);
  out << (job != nullptr);
  if (job) out << job->name << job->toml << job->everywhere;
  tell_others(ranks, out);
}

std::optional<CrewJob> called_by(Ranks& ranks) {
  const Ranks::Message incoming = next_message(ranks);
  BytesIn in(incoming.bytes);
  Kind kind{};
  bool there = false;
  in >> kind >> there;
  if (kind != Kind::job) throw InternalError("a rank was told something before its job");
  if (!there) return {};
  CrewJob job;
  in >> job.name >> job.toml >> job.everywhere;
  return job;
}

// An exception of its own ends the process, and with it the crew.
Muster::~Muster() {
  if (!ranks_) return;
  BytesOut out = message(Kind::stop);
  out << Why::failed;
  tell_others(*ranks_, out);
}

Foreman::Foreman(Ranks& ranks, const CrewPlan& plan, Calls calls)
    : ranks_(ranks),
      plan_(plan),
      calls_(std::move(calls)),
      left_(ranks.size() - 1),
      told_(static_cast<std::size_t>(ranks.size()), 0) {
  // First the thread, which may fail: whoever has the plan has somebody who listens.
  thread_ = std::thread([this] { serve(); });
}

Foreman::~Foreman() {
  if (!thread_.joinable()) return;
  failed_ = ended_ = true;  // an exception is on its way
  thread_.join();
}

void Foreman::wait() {
  thread_.join();
  if (!error_.empty()) throw InputError(error_);
}

void Foreman::fail(const std::string& error) {
  failed_ = ended_ = true;
  if (error_.empty()) error_ = error;
}

void Foreman::serve() {
  BytesOut out = message(Kind::plan);
  out << plan_.records << plan_.seconds << plan_.trajectories;
  tell_others(ranks_, out);
  while (left_ > 0) {
    if (ended_ || calls_.stopped())
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
  BytesOut out = message(Kind::stop);
  out << (failed_ || calls_.failed() ? Why::failed : Why::done);
  ranks_.send(rank, out.bytes);
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
  bool last = false, interrupted = false, with_part = false;
  std::string error;
  in >> last >> interrupted >> error >> with_part;
  if (interrupted) ended_ = true;
  if (!error.empty()) fail(error);
  try {
    if (with_part) calls_.take(in);
  } catch (const std::exception& problem) {
    fail(text_of(problem));
  }
  if (last) {
    --left_;
    stop(incoming.from);
  }
}

Hand::Hand(Ranks& ranks) : ranks_(ranks) {
  for (;;) {
    const Ranks::Message incoming = next_message(ranks_);
    BytesIn in(incoming.bytes);
    Kind kind{};
    in >> kind;
    if (kind == Kind::stop) throw InputError("the first process of this run could not begin");
    if (kind != Kind::plan) continue;
    in >> plan_.records >> plan_.seconds >> plan_.trajectories;
    return;
  }
}

// Only where an exception is on its way, which is told.
Hand::~Hand() { end("a process of this run ended early"); }

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
  if (thread_.joinable())
    thread_.join();
  else
    take_leave(error);
  if (error.empty() && failed_) throw InputError("another process of this run failed");
}

// What was done is of no use to a crew that has failed.
void Hand::tell(bool last, const std::string& error) {
  BytesOut out = message(Kind::part);
  const bool interrupted = interrupted_ && *interrupted_;
  const bool with_part = calls_.take && !failed_;
  out << last << interrupted << error << with_part;
  if (with_part) calls_.take(out);
  ranks_.send(0, out.bytes);
}

void Hand::read(const Ranks::Message& incoming) {
  BytesIn in(incoming.bytes);
  Kind kind{};
  in >> kind;
  const std::lock_guard lock(mutex_);
  if (kind == Kind::stop) {
    Why why{};
    in >> why;
    failed_ = why == Why::failed;
    stopped_ = true;
  }
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
    if (!stopped_ && (now - told > between || calls_.heavy())) {
      tell(false, "");
      told = now;
    }
    if (!incoming) std::this_thread::sleep_for(pause);
  }
  take_leave(error_);
}

void Hand::take_leave(const std::string& error) {
  tell(true, error);
  while (asked_ || !stopped_) read(next_message(ranks_));
}

}  // namespace carom
