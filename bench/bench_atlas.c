#include "bench.h"
int bench_atlas(const bench_options *o){(void)o;return 0;}
