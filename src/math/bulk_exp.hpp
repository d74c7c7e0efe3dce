// Exponentials of many numbers at once, with the bits of exp_portable.
#pragma once

namespace lilytank {

/// out[i] = exp_portable(x[i]) for i < count; `out` may be `x`.
void bulk_exp(const double* x, int count, double* out);

}  // namespace lilytank
