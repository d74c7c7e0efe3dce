// Fontconfig keeps its tables until the program ends; the leak checker of sanitizer builds is told
// so, that it goes on to watch our own memory.
#if defined(__SANITIZE_ADDRESS__)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig\n";
}
#endif
