#include "ehdjet/core/error.hpp"

namespace ehdjet {

void contract_failed(const char* kind, const char* condition, const char* file, int line) {
  throw ContractViolation(std::string(kind) + " broken: " + condition + " (" + file + ":"
                          + std::to_string(line)
                          + "). This is a bug in ehdjet; please report it");
}

} // namespace ehdjet
