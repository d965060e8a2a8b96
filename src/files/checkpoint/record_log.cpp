#include "files/checkpoint/record_log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <type_traits>
#include <utility>

#include "carom/base/digest.hpp"
#include "carom/base/error.hpp"
#include "files/checkpoint/work_folder.hpp"
#include "files/platform.hpp"

namespace carom::files {

namespace {

static_assert(std::is_trivially_copyable_v<TrajectoryRecord>);
constexpr std::size_t record_size = sizeof(TrajectoryRecord);
// 16 MB wait in memory before they are written, more where the disk is full; 4 MB are read at a
// time.
constexpr std::size_t enough_waiting = (std::size_t{16} << 20) / record_size;
constexpr std::size_t most_waiting = (std::size_t{256} << 20) / record_size;
static_assert(record_size % sizeof(std::uint64_t) == 0);
constexpr std::uint64_t batch_size = (std::size_t{4} << 20) / record_size;

// Goes on from the hash of what is before: any changed word gives another one.
std::uint64_t hashed(std::uint64_t sum, const TrajectoryRecord* records, std::size_t count) {
  const char* from = reinterpret_cast<const char*>(records);
  for (std::size_t at = 0; at < count * record_size; at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, from + at, sizeof word);
    sum = mix(sum ^ word);
  }
  return sum;
}

}  // namespace

RecordLog::RecordLog(const std::string& path, const std::string& name)
    : path_(path), name_(name), next_write_(enough_waiting) {
  descriptor_ = create_file(path);
  if (descriptor_ < 0) fail("write");
}

RecordLog::RecordLog(const std::string& path, const std::string& name, std::vector<Piece> pieces)
    : path_(path), name_(name), next_write_(enough_waiting), pieces_(std::move(pieces)) {
  for (const Piece& piece : pieces_) rows_ = std::max(rows_, piece.row + piece.rows);
  marked_ = pieces_;
  descriptor_ = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor_ < 0)
    throw InputError(Place{path, 0, 0, ""},
                     errno == ENOENT ? "there is no such file"
                                     : fmt::format("it cannot be opened: {}", std::strerror(errno)),
                     "the records that the checkpoint names");
  struct stat about {};
  const std::uint64_t bytes = rows_ * record_size;
  const bool whole =
      ::fstat(descriptor_, &about) == 0 && static_cast<std::uint64_t>(about.st_size) >= bytes;
  if (!whole || ::ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) {
    ::close(descriptor_);
    throw InputError(Place{path, 0, 0, ""}, "records that the checkpoint names are missing");
  }
  kept_ = true;
  // Now, and not after hours of computing. Reading takes seconds where writing took minutes.
  try {
    read([](const Piece&, const std::vector<TrajectoryRecord>&) {});
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

RecordLog::~RecordLog() {
  ::close(descriptor_);
  if (!kept_) std::remove(path_.c_str());
}

void RecordLog::fail(const char* what) const {
  const int error = errno;
  throw InputError(fmt::format("cannot {} '{}': {}", what, name_, std::strerror(error)));
}

void RecordLog::add(TrajectoryRange range, std::vector<TrajectoryRecord>&& records) {
  const std::lock_guard lock(mutex_);
  waiting_records_ += records.size();
  waiting_.push_back({range, std::move(records)});
  if (waiting_records_ < next_write_) return;
  try {
    write_out();
  } catch (const InputError&) {
    if (waiting_records_ >= most_waiting) throw;
  }
  next_write_ = waiting_records_ + enough_waiting;
}

// Writes in the order of trajectories, so that neighbours make one piece.
void RecordLog::write_out() {
  std::sort(waiting_.begin(), waiting_.end(),
            [](const Block& a, const Block& b) { return a.range.first < b.range.first; });
  std::vector<TrajectoryRecord> all;
  all.reserve(waiting_records_);
  for (const Block& block : waiting_)
    all.insert(all.end(), block.records.begin(), block.records.end());
  const char* from = reinterpret_cast<const char*>(all.data());
  std::size_t left = all.size() * record_size;
  auto at = static_cast<off_t>(rows_ * record_size);
  while (left > 0) {
    const ssize_t written = ::pwrite(descriptor_, from, left, at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("write");
    from += written;
    at += written;
    left -= static_cast<std::size_t>(written);
  }
  const TrajectoryRecord* records = all.data();
  for (const Block& block : waiting_) {
    const std::uint64_t count = block.records.size();
    const bool follows = !pieces_.empty() && pieces_.back().last == block.range.first &&
                         pieces_.back().row + pieces_.back().rows == rows_;
    if (follows) {
      pieces_.back().last = block.range.last;
      pieces_.back().rows += count;
    } else {
      pieces_.push_back({block.range.first, block.range.last, rows_, count});
    }
    pieces_.back().sum = hashed(pieces_.back().sum, records, count);
    records += count;
    rows_ += count;
  }
  waiting_.clear();
  waiting_records_ = 0;
}

void RecordLog::mark() {
  const std::lock_guard lock(mutex_);
  write_out();
  marked_ = pieces_;
}

std::vector<RecordLog::Piece> RecordLog::sync() {
  // An error is reported once; after it the state of the disk is unknown.
  if (!broken_ && !sync_contents(descriptor_)) broken_ = errno;
  if (broken_) {
    errno = broken_;
    fail("write");
  }
  const std::lock_guard lock(mutex_);
  return marked_;
}

void RecordLog::read(
    const std::function<void(const Piece&, const std::vector<TrajectoryRecord>&)>& batch) const {
  std::vector<Piece> pieces = marked_;
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return a.first < b.first; });
  std::vector<TrajectoryRecord> records;
  for (Piece piece : pieces) {
    std::uint64_t sum = 0;
    while (piece.rows > 0) {
      records.resize(std::min(batch_size, piece.rows));
      char* to = reinterpret_cast<char*>(records.data());
      std::size_t left = records.size() * record_size;
      auto at = static_cast<off_t>(piece.row * record_size);
      while (left > 0) {
        const ssize_t got = ::pread(descriptor_, to, left, at);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) fail("read");
        to += got;
        at += got;
        left -= static_cast<std::size_t>(got);
      }
      sum = hashed(sum, records.data(), records.size());
      batch(piece, records);
      piece.row += records.size();
      piece.rows -= records.size();
    }
    if (sum != piece.sum)
      throw InputError(Place{path_, 0, 0, ""},
                       fmt::format("the records of the trajectories {} to {} were changed",
                                   piece.first, piece.last - 1),
                       "records as carom wrote them");
  }
}

}  // namespace carom::files
