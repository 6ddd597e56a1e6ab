/* A disk that fails on demand. Preloaded (LD_PRELOAD), it counts one kind of calls, 1, 2, 3, ... in
 * the order in which they come, and acts on one of them. Kinds, by JOSTLE_FAULT_OF:
 *
 *   changes  (default) write, writev, pwrite, pwrite64, fsync, fdatasync, ftruncate, ftruncate64,
 *            rename, renameat, link, unlink and rmdir that touch a path beginning with JOSTLE_FAULT_PATH,
 *            or a descriptor open on one
 *   reads    read, readv, pread and pread64 of such a descriptor
 *   output   write and writev to descriptor 1, whatever it is open on
 *
 *   JOSTLE_FAULT_PATH    prefix of the absolute paths that count; unset: none does
 *   JOSTLE_FAULT_COUNT   a file outside that prefix; at exit the number of calls so far is written
 *                        to it as text
 *   JOSTLE_FAULT_LOG     a file outside that prefix; a line "name path" is added to it for each call
 *   JOSTLE_FAULT_AT      the number of the call to act on
 *   JOSTLE_FAULT_ACTION  kill_before  SIGKILL instead of the call
 *                        kill_after   the call, then SIGKILL
 *                        kill_within  half the bytes of a write, then SIGKILL (else as kill_before)
 *                        pause        SIGSTOP before the call; SIGCONT goes on with it
 *                        no_space     the call and every later write or ftruncate fail with ENOSPC
 *                        fsync_fails  the call and every later fsync fail with EIO
 *                        broken       the call alone fails with EIO
 *                        interrupted  the call alone fails with EINTR, if it reads or writes
 *                        shortened    half the bytes of a read or a write, one at least
 *
 * No action or no number: calls are only counted. Besides, and whatever these say:
 *
 *   JOSTLE_NO_FLOCK      the errno that every flock fails with, as on a file system that has none */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

static atomic_long calls;

static const char* prefix(void) { return getenv("JOSTLE_FAULT_PATH"); }

static int counts_kind(const char* kind) {
  const char* chosen = getenv("JOSTLE_FAULT_OF");
  return !strcmp(chosen ? chosen : "changes", kind);
}

static int is_below(const char* path) {
  const char* start = prefix();
  if (!start || !path) return 0;
  char absolute[8192];
  if (path[0] != '/') {
    char folder[4096];
    if (!getcwd(folder, sizeof folder)) return 0;
    snprintf(absolute, sizeof absolute, "%s/%s", folder, path);
    path = absolute;
  }
  return strncmp(path, start, strlen(start)) == 0;
}

/* The path that a descriptor is open on, in a buffer of 4096; empty if it has none. */
static const char* path_of(int descriptor, char* path) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t n = readlink(link, path, 4095);
  path[n > 0 ? n : 0] = 0;
  return path;
}

static int counts_path(const char* path) { return counts_kind("changes") && is_below(path); }

static int is_open_below(int descriptor) {
  char path[4096];  // "pipe:[17]" of a pipe, which is below no folder
  return prefix() && path_of(descriptor, path)[0] == '/' && is_below(path);
}
static int counts_descriptor(int descriptor) {
  return counts_kind("changes") && is_open_below(descriptor);
}
static int counts_write(int descriptor) {
  return counts_descriptor(descriptor) || (descriptor == 1 && counts_kind("output"));
}
static int counts_read(int descriptor) {
  return counts_kind("reads") && is_open_below(descriptor);
}

static void note(const char* name, const char* path) {
  const char* log = getenv("JOSTLE_FAULT_LOG");
  FILE* file = log ? fopen(log, "a") : NULL;
  if (!file) return;
  fprintf(file, "%s %s\n", name, path);
  fclose(file);
}

static void note_descriptor(const char* name, int descriptor) {
  char path[4096];
  if (getenv("JOSTLE_FAULT_LOG")) note(name, path_of(descriptor, path));
}

static void die(void) {
  syscall(SYS_kill, getpid(), SIGKILL);
  for (;;) pause();
}

enum kind { writes, reads, syncs, others };
struct verdict {
  int error;      /* errno to fail with, 0: go on */
  int kill_after; /* die once the call is done */
  int halve;      /* write half, then die */
  int shorten;    /* read or write half */
};

static struct verdict judge(enum kind kind) {
  struct verdict verdict = {0, 0, 0, 0};
  const long number = atomic_fetch_add(&calls, 1) + 1;
  const char* at_text = getenv("JOSTLE_FAULT_AT");
  const char* action = getenv("JOSTLE_FAULT_ACTION");
  if (!at_text || !action) return verdict;
  const long at = atol(at_text);
  if (number >= at && kind == writes && !strcmp(action, "no_space")) verdict.error = ENOSPC;
  if (number >= at && kind == syncs && !strcmp(action, "fsync_fails")) verdict.error = EIO;
  if (number != at) return verdict;
  const int moves_bytes = kind == writes || kind == reads;
  if (!strcmp(action, "broken")) verdict.error = EIO;
  if (!strcmp(action, "interrupted") && moves_bytes) verdict.error = EINTR;
  if (!strcmp(action, "shortened") && moves_bytes) verdict.shorten = 1;
  if (!strcmp(action, "kill_before")) die();
  if (!strcmp(action, "pause")) syscall(SYS_kill, getpid(), SIGSTOP);
  if (!strcmp(action, "kill_after")) verdict.kill_after = 1;
  if (!strcmp(action, "kill_within")) {
    if (kind != writes) die();
    verdict.halve = 1;
  }
  return verdict;
}

static size_t shortened(struct verdict verdict, size_t n) {
  if (verdict.halve) return n / 2;
  return verdict.shorten && n > 1 ? n / 2 : n;
}

#define NEXT(name) (__extension__(__typeof__(&name))dlsym(RTLD_NEXT, #name))

#define ACT(kind, call)                  \
  const struct verdict v = judge(kind);  \
  if (v.error) {                         \
    errno = v.error;                     \
    return -1;                           \
  }                                      \
  const __typeof__(call) result = (call); \
  if (v.kill_after || v.halve) die();    \
  return result

ssize_t write(int descriptor, const void* bytes, size_t n) {
  if (!counts_write(descriptor)) return NEXT(write)(descriptor, bytes, n);
  note_descriptor("write", descriptor);
  ACT(writes, NEXT(write)(descriptor, bytes, shortened(v, n)));
}

/* A shorter one is the first of its pieces alone. */
ssize_t writev(int descriptor, const struct iovec* pieces, int n) {
  if (!counts_write(descriptor)) return NEXT(writev)(descriptor, pieces, n);
  note_descriptor("writev", descriptor);
  ACT(writes, NEXT(writev)(descriptor, pieces, v.shorten || v.halve ? 1 : n));
}

ssize_t read(int descriptor, void* bytes, size_t n) {
  if (!counts_read(descriptor)) return NEXT(read)(descriptor, bytes, n);
  note_descriptor("read", descriptor);
  ACT(reads, NEXT(read)(descriptor, bytes, shortened(v, n)));
}

ssize_t readv(int descriptor, const struct iovec* pieces, int n) {
  if (!counts_read(descriptor)) return NEXT(readv)(descriptor, pieces, n);
  note_descriptor("readv", descriptor);
  ACT(reads, NEXT(readv)(descriptor, pieces, v.shorten ? 1 : n));
}

ssize_t pread(int descriptor, void* bytes, size_t n, off_t offset) {
  if (!counts_read(descriptor)) return NEXT(pread)(descriptor, bytes, n, offset);
  note_descriptor("pread", descriptor);
  ACT(reads, NEXT(pread)(descriptor, bytes, shortened(v, n), offset));
}

ssize_t pread64(int descriptor, void* bytes, size_t n, off64_t offset) {
  if (!counts_read(descriptor)) return NEXT(pread64)(descriptor, bytes, n, offset);
  note_descriptor("pread64", descriptor);
  ACT(reads, NEXT(pread64)(descriptor, bytes, shortened(v, n), offset));
}

ssize_t pwrite(int descriptor, const void* bytes, size_t n, off_t offset) {
  if (!counts_descriptor(descriptor)) return NEXT(pwrite)(descriptor, bytes, n, offset);
  note_descriptor("pwrite", descriptor);
  ACT(writes, NEXT(pwrite)(descriptor, bytes, shortened(v, n), offset));
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t n, off64_t offset) {
  if (!counts_descriptor(descriptor)) return NEXT(pwrite64)(descriptor, bytes, n, offset);
  note_descriptor("pwrite64", descriptor);
  ACT(writes, NEXT(pwrite64)(descriptor, bytes, shortened(v, n), offset));
}

int ftruncate(int descriptor, off_t size) {
  if (!counts_descriptor(descriptor)) return NEXT(ftruncate)(descriptor, size);
  note_descriptor("ftruncate", descriptor);
  ACT(writes, NEXT(ftruncate)(descriptor, size));
}

int ftruncate64(int descriptor, off64_t size) {
  if (!counts_descriptor(descriptor)) return NEXT(ftruncate64)(descriptor, size);
  note_descriptor("ftruncate64", descriptor);
  ACT(writes, NEXT(ftruncate64)(descriptor, size));
}

int fsync(int descriptor) {
  if (!counts_descriptor(descriptor)) return NEXT(fsync)(descriptor);
  note_descriptor("fsync", descriptor);
  ACT(syncs, NEXT(fsync)(descriptor));
}

int fdatasync(int descriptor) {
  if (!counts_descriptor(descriptor)) return NEXT(fdatasync)(descriptor);
  note_descriptor("fdatasync", descriptor);
  ACT(syncs, NEXT(fdatasync)(descriptor));
}

int rename(const char* from, const char* to) {
  if (!counts_path(to)) return NEXT(rename)(from, to);
  note("rename", to);
  ACT(others, NEXT(rename)(from, to));
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  if (!counts_path(to)) return NEXT(renameat)(from_folder, from, to_folder, to);
  note("renameat", to);
  ACT(others, NEXT(renameat)(from_folder, from, to_folder, to));
}

int link(const char* from, const char* to) {
  if (!counts_path(to)) return NEXT(link)(from, to);
  note("link", to);
  ACT(others, NEXT(link)(from, to));
}

int unlink(const char* path) {
  if (!counts_path(path)) return NEXT(unlink)(path);
  note("unlink", path);
  ACT(others, NEXT(unlink)(path));
}

int rmdir(const char* path) {
  if (!counts_path(path)) return NEXT(rmdir)(path);
  note("rmdir", path);
  ACT(others, NEXT(rmdir)(path));
}

int flock(int descriptor, int operation) {
  const char* error = getenv("JOSTLE_NO_FLOCK");
  if (!error) return NEXT(flock)(descriptor, operation);
  errno = atoi(error);
  return -1;
}

__attribute__((destructor)) static void report(void) {
  const char* path = getenv("JOSTLE_FAULT_COUNT");
  if (!path) return;
  FILE* file = fopen(path, "w");
  if (!file) return;
  fprintf(file, "%ld\n", atomic_load(&calls));
  fclose(file);
}
