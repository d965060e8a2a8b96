// Is what an archive of an ensemble holds a result of its system? InputError where it is not.
#pragma once

#include "carom/analyses/kinds.hpp"
#include "carom/files/ensembles.hpp"

namespace carom::analyses {

void check(const StoredEnsemble&, const EscapeResult&, const System&);
void check(const StoredEnsemble&, const DiffusionResult&, const System&);
void check(const StoredEnsemble&, const LyapunovResult&, const System&);

}  // namespace carom::analyses
