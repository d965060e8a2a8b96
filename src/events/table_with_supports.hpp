// Edges of supports as walls: where a free flight meets one, integration takes over.
#pragma once

#include "carom/events/dynamics.hpp"
#include "carom/table/table.hpp"

namespace carom {

/// The table with a circle for each support, its outside being the domain of free flights. Without
/// walls where free flights never occur or nothing has a finite support.
Table table_with_supports(const Table& table, const Dynamics& dynamics);

/// The table as the centres of hard discs see it. Throws InputError where it cannot be built.
Table table_of_discs(const Table& table, const Dynamics& dynamics);

}  // namespace carom
