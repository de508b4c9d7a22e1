#include "bench.h"
int bench_maps(const bench_options *o){(void)o;return 0;}
