// cases.h - how many random cases a test draws: those it names, or AISLE_TEST_CASES per cent of them, rounded up. Set by
// CMake (-DAISLE_TEST_CASES=1000 for a long run; the presets for other compilers and sanitizers look at fewer). What a test
// must have met at least among its cases scales with them.
#ifndef CASES_H
#define CASES_H

#ifndef AISLE_TEST_CASES
#define AISLE_TEST_CASES 100
#endif
#define CASES(named) (((named)*AISLE_TEST_CASES + 99) / 100)
#define LEAST(named) ((named)*AISLE_TEST_CASES / 100)                   // rounded down: what few cases may lack
#define OF_ALL(cases) (CASES(cases) < (cases) ? CASES(cases) : (cases)) // of cases that are listed, not drawn
#endif
