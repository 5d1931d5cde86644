#include "ehdjet/observers/observer.hpp"

namespace ehdjet {

Observer::~Observer() = default;

} // namespace ehdjet
