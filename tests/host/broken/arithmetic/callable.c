/* callable.c -- broken: ambit_entry is a function. */
__attribute__((visibility("default"))) int ambit_entry(void);
int ambit_entry(void) { return 0; }
