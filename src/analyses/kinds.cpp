// What files ask of each kind of ensemble.
#include "carom/analyses/kinds.hpp"

#include "analyses/checks.hpp"
#include "analyses/diffusion/describe.hpp"
#include "analyses/escape/describe.hpp"
#include "analyses/lyapunov/describe.hpp"
#include "analyses/returns/describe.hpp"
#include "files/describe/archive_in.hpp"
#include "files/describe/archive_out.hpp"

namespace carom {

using namespace files;

void files::write_counts(const ArchiveFile& file, const auto& result, const System& system) {
  ArchiveOut out(file);
  analyses::describe(out, result, system);
}
void files::read_counts(hid_t file, const std::string& name, auto& result) {
  ArchiveIn in(file, name);
  analyses::describe(in, result, System());
}

template <class Result>
void check_stored(const Stored<Result>& stored, const System& system) {
  analyses::check(stored, stored.result, system);
}

#define CAROM_MAKE(Result)                                                             \
  template void check_stored(const Stored<Result>&, const System&);                    \
  template void files::write_counts(const ArchiveFile&, const Result&, const System&); \
  template void files::read_counts(hid_t, const std::string&, Result&);
CAROM_FOR_ENSEMBLES(CAROM_MAKE)
#undef CAROM_MAKE

std::vector<std::string> keys_of_reports(const StoredEnsemble& stored) {
  if (stored.kind == kind_of(LyapunovResult())) return {};
  return {"run.window"};
}

}  // namespace carom
