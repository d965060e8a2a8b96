// Is what an archive of an ensemble holds a result of its system? InputError where it is not.
#pragma once

#include "carom/analyses/kinds.hpp"
#include "carom/files/ensembles.hpp"

namespace carom::analyses {

#define CAROM_DECLARE(Result) void check(const StoredEnsemble&, const Result&, const System&);
CAROM_FOR_ENSEMBLES(CAROM_DECLARE)
#undef CAROM_DECLARE

}  // namespace carom::analyses
