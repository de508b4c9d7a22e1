#include "bench.h"
int bench_trace(const bench_options *o){(void)o;return 0;}
