// Ends the program with a message where the processor lacks instructions that the program is
// compiled for. This file is compiled for the oldest processor of its kind, and its function runs
// before all other code of the program, as initializers of variables may have such instructions.
#include <unistd.h>

namespace {

#if defined(__x86_64__) && defined(SUNDER_FOR_V3)

constexpr char kMessage[] =
    "failed: this program is compiled for processors with AVX2, BMI2 and FMA (x86-64-v3), which "
    "this processor lacks; compile it with cmake -DSUNDER_ARCH=x86-64-v2\n";

__attribute__((constructor(101))) void check_processor() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
      __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma"))
    return;
  if (::write(STDERR_FILENO, kMessage, sizeof kMessage - 1) < 0) ::_exit(2);
  ::_exit(1);
}

#endif

}  // namespace
