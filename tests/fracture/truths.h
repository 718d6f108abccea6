// Invariants of every fracture, checked from first principles.
#pragma once

#include <string>

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Returns "" if a break of `parent` keeps all invariants; otherwise the first violation.
std::string find_violation(const Compound& parent, const BreakPlan& plan);

/// Returns the contacts of a compound by the paper's method: faces sorted by |d| of their planes,
/// every pair of similar |d| checked. This reference for tests is slow where many faces share |d|.
std::vector<Bond> contacts_by_distance(const Compound& compound, double tolerance);

}  // namespace sunder::fracture
