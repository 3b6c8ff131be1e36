// SPDX-License-Identifier: BSD-3-Clause
// No method allocates inside a step once its first two steps are done. A program of its own, because it
// replaces operator new and Eigen's way to memory, malloc.
#include <malloc.h>

#include <catch2/catch.hpp>

#include "core/integrators/integrator.hpp"
#include "core/simulate/initial_state.hpp"
#include "tests/support/models.hpp"

extern "C" void* __libc_malloc(std::size_t);
extern "C" void* __libc_realloc(void*, std::size_t);
extern "C" void* __libc_calloc(std::size_t, std::size_t);
extern "C" void* __libc_memalign(std::size_t, std::size_t);

namespace {
long count = 0;  // this program has one thread
}

// Eigen allocates by malloc, the library's operator new by malloc too: one counter sees both.
extern "C" void* malloc(std::size_t size) {
  ++count;
  return __libc_malloc(size);
}
extern "C" void* realloc(void* old, std::size_t size) {
  ++count;
  return __libc_realloc(old, size);
}
extern "C" void* calloc(std::size_t n, std::size_t size) {
  ++count;
  return __libc_calloc(n, size);
}
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++count;
  return __libc_memalign(alignment, size);
}
extern "C" int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  ++count;
  *out = __libc_memalign(alignment, size);
  return *out ? 0 : 12;  // ENOMEM
}

using namespace unfurl;
using namespace unfurl::testing;

namespace {

struct Counted {
  long allocations = 0;
  bool converged = true;
};

Counted count_steps(const Structure& structure, const SolverOptions& options, double h) {
  const auto model = make_model(structure);
  const auto integrator = find_method(options.method)->make(model->system, options);
  State state = initial_state(structure, model->system).state;
  Counted out;
  for (int i = 0; i < 2; ++i) out.converged = integrator->step(state, h).ok() && out.converged;
  const long before = count;
  for (int i = 0; i < 20; ++i) out.converged = integrator->step(state, h).ok() && out.converged;
  out.allocations = count - before;
  return out;
}

}  // namespace

TEST_CASE("the counter sees what C++ and Eigen allocate") {
  const long before = count;
  std::vector<int> numbers(100, 1);
  const long one = count;
  VectorXd vector = VectorXd::Ones(numbers[0] * 100);
  CHECK(one == before + 1);
  CHECK(count == one + 1);
  CHECK(vector.sum() == 100.0);
}

TEST_CASE("no method allocates inside a step") {
  for (const Method& method : methods())
    for (int stages : {2, 3, 6})
      for (const char* at : {"nodes", "ends"}) {
        SolverOptions options;
        options.method = method.name;
        options.stages = stages;
        options.constraints_at = at;
        INFO(method.name << ", " << stages << " stages, constraints at " << at);
        // A ring with redundant rows, linear constraints eliminated; and a pendulum under gravity.
        const Counted ring = count_steps(hoop_structure(), options, 0.01);
        const Counted pendulum = count_steps(double_pendulum(), options, 0.01);
        CHECK(ring.converged);
        CHECK(ring.allocations == 0);
        CHECK(pendulum.converged);
        CHECK(pendulum.allocations == 0);
      }
}
