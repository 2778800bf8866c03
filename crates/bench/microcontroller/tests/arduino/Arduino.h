// The part of Arduino's core that the sketch needs, over a pipe: each call is a line on standard output, and its result is a line on
// standard input. The process at the other ends has the bus, the clock and the serial port.
#pragma once
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

// Sends a call and returns the first number of its result.
inline long asked(const char *form, long number) {
  printf(form, number);
  fflush(stdout);
  char answer[64];
  if (!fgets(answer, sizeof answer, stdin)) exit(0); // the other process has ended
  return strtol(answer, nullptr, 10);
}

enum { LOW, HIGH, INPUT, OUTPUT };
inline void delay(unsigned long ms) { asked("delay %ld\n", 1000 * ms); }
inline unsigned long micros() { return (unsigned long)(uint32_t)asked("micros %ld\n", 0); }
inline void pinMode(int, int) {}
inline void digitalWrite(int pin, int level) { asked(level == LOW ? "low %ld\n" : "high %ld\n", pin); }

struct SerialPort {
  void begin(unsigned long baud) { asked("baud %ld\n", (long)baud); }
  void println(const char *text) {
    printf("line %s\n", text);
    fflush(stdout);
    asked("sent %ld\n", 0);
  }
};
inline SerialPort Serial;
