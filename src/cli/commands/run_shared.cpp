#include "cli/commands/run_shared.hpp"

#include <fstream>
#include <iterator>
#include <new>
#include <sstream>

namespace carom::cli {

ShareEnd share_end_of(const std::function<void(ShareEnd&)>& work) {
  ShareEnd end;
  try {
    work(end);
  } catch (const SamplingStopped&) {
    end.stopped = true;
    end.exception = std::current_exception();
  } catch (const std::exception& error) {
    end.error = dynamic_cast<const std::bad_alloc*>(&error) ? "out of memory" : error.what();
    end.exception = std::current_exception();
  }
  return end;
}

std::vector<ShareEnd> gather_ends(Ranks& ranks, const ShareEnd& mine) {
  std::vector<ShareEnd> ends;
  ranks.gather(fmt::format("{} {:d}\n{}", mine.kept, mine.stopped, mine.error),
               [&](int rank, const std::string& text) {
                 ShareEnd end = rank == 0 ? mine : ShareEnd();
                 std::istringstream in(text);
                 in >> end.kept >> end.stopped;
                 in.ignore();
                 end.error.assign(std::istreambuf_iterator<char>(in), {});
                 ends.push_back(end);
               });
  ranks.gather(fmt::format("{}", fmt::join(mine.warnings, "\n")),
               [](int rank, const std::string& text) {
                 std::istringstream in(text);
                 for (std::string line; std::getline(in, line);)
                   warn(fmt::format("rank {}: {}", rank, line));
               });
  return ends;
}

void throw_first_error(const std::vector<ShareEnd>& ends) {
  for (const ShareEnd& end : ends) {
    if (end.error.empty()) continue;
    if (end.exception) std::rethrow_exception(end.exception);
    throw InputError(end.error);
  }
  for (const ShareEnd& end : ends)
    if (end.stopped) throw SamplingStopped();
}

// The first rank does not find a part that a rank could not read or write.
void send_parts(Ranks& ranks, const std::string& part, const std::string& first_file) {
  std::ifstream in(part, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  ranks.gather(bytes, [&](int rank, const std::string& text) {
    if (rank == 0) return;
    files::write_new_file(files::part_of_rank(first_file, rank), text);
  });
}

}  // namespace carom::cli
