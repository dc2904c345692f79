/*
 * main.c -- the program `resonance`: a deck in, a file of results and a short table out.
 */
#define _POSIX_C_SOURCE 200809L /* fdopen */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "farm/ranks.h"
#include "pages.h"
#include "results/failed.h"
#include "scenes/outer.h"
#include "run.h"
#include "shard.h"
#include "system/ending.h"
#include "system/file.h"
#include "system/grow.h"
#include "system/text.h"
#include "terminal/safe_text.h"
#include "terminal/signals.h"

/* All that a run holds; zero at first, so that it can be let go of half-built. */
typedef struct job {
  options options;
  progress progress;
  deck *decks;     /* as many as there are names; those that had their turn are empty */
  size_t turn;     /* of decks */

  /* Of the deck whose turn it is. */
  provenance provenance;
  deck deck;
  const scene_kind *scene;
  pendres_options precision;
  farm *farm;
  journal *journal; /* NULL: none */
  scene_run run;
  text table;
} job;

/*
 * A standard stream that came closed is opened the wrong way round, so that its use fails as
 * before: left alone, its number would go to the next file opened, and messages into the results.
 */
static int hold_streams(void)
{
  for (int fd = 0; fd <= 2; fd++)
    if (fcntl(fd, F_GETFD) == -1 && open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY) != fd)
      return FAILED;
  return DONE;
}

/* --output takes the place of the deck's. */
static int override_output(job *j, deck *d)
{
  const char *name = j->options.output;
  if (name == NULL) return DONE;
  if (strlen(name) >= sizeof d->output) {
    progress_error(&j->progress, "the name of the output is too long");
    return BAD_USAGE;
  }
  strcpy(d->output, name);
  return DONE;
}

/* A name that promises text is none for HDF5. */
static int check_extension(job *j, const deck *d)
{
  const size_t n = strlen(d->output);
  if (n < 4 || strcmp(d->output + n - 4, ".csv") != 0) return DONE;
  progress_error(&j->progress, "%s: results are an HDF5 file, which this name promises not to be; "
                 "-o %.*s.h5 --csv writes both", d->output, (int)n - 4, d->output);
  return BAD_USAGE;
}

static int read_deck(job *j, const char *name, deck *d)
{
  namelist_errors errors = { 0 };
  pendres_options precision;
  const char *why = NULL;
  const pendres_status status = deck_read_set(name, (const char *const *)j->options.setting,
                                              j->options.setting_count, d, &errors);
  namelist_errors_print(&errors, stderr);
  namelist_errors_free(&errors);
  if (status == PENDRES_OUT_OF_MEMORY) {
    progress_error(&j->progress, "%s: out of memory for the deck", name);
    return FAILED;
  }
  if (status != PENDRES_OK) return BAD_USAGE;
  if (override_output(j, d) != DONE || check_extension(j, d) != DONE ||
      files_check(d, j->options.log, &j->progress) != DONE ||
      (j->options.csv && !j->options.force && csv_check(d, &j->progress) != DONE))
    return BAD_USAGE;
  if (scene_precision(d, &precision, &why) != PENDRES_OK) {
    progress_error(&j->progress, "%s: &precision: %s", d->name, why);
    return BAD_USAGE;
  }
  return DONE;
}

/* All of them, so that nothing is computed if one is bad. */
static int read_decks(job *j)
{
  const size_t count = j->options.deck_count;
  int code = DONE;
  j->decks = calloc(count, sizeof *j->decks);
  if (j->decks == NULL) {
    progress_error(&j->progress, "out of memory for the decks");
    return FAILED;
  }
  for (size_t i = 0; i < count; i++) {
    const int one = read_deck(j, j->options.deck[i], &j->decks[i]);
    if (one == FAILED) return FAILED;
    if (one != DONE) code = one;
    for (size_t k = 0; k < i && one == DONE && j->options.action == OPTIONS_RUN; k++) {
      if (j->decks[k].name == NULL || !files_same(j->decks[k].output, j->decks[i].output)) continue;
      progress_error(&j->progress, "the decks %s and %s both write %s", j->decks[k].name,
                     j->decks[i].name, j->decks[i].output);
      code = BAD_USAGE;
    }
  }
  return code;
}

/* Another rank than 0 gets them from there. */
static int await_decks(job *j)
{
  j->decks = calloc(j->options.deck_count, sizeof *j->decks);
  return j->decks != NULL ? DONE : FAILED;
}

/* What rank 0 has found, or that another rank cannot go on, of which it has not informed others. */
static int agree(job *j, int code)
{
  const int ready = together_ready(code == DONE || !together_helping());
  code = together_agree(code);
  if (ready || code != DONE) return code;
  progress_error(&j->progress, "another rank cannot begin: it has no memory, or no room in the "
                 "folder that TMPDIR names there (default: /tmp)");
  return FAILED;
}

static int find_scene(job *j)
{
  j->scene = scene_find(j->deck.kind);
  if (j->scene != NULL) return DONE;
  progress_error(&j->progress, "%s: this build has no scene '%s'", j->deck.name,
                 deck_kind_name(j->deck.kind));
  return FAILED;
}

static int check_stdout(job *j)
{
  if (fflush(stdout) == 0 && !ferror(stdout)) return DONE;
  progress_error(&j->progress, "standard output: %s", strerror(errno));
  return FAILED;
}

static int dump(job *j)
{
  if (deck_dump(&j->deck, stdout) == PENDRES_OUT_OF_MEMORY) return FAILED;
  return check_stdout(j);
}

/* What a library does when it ends the program is known from here on. */
static int watch(job *j)
{
  if (ending_watch(&j->run.store) == 0) return DONE;
  progress_error(&j->progress, "the system refuses handlers of exits and faults");
  return FAILED;
}

static int look_ahead(job *j)
{
  j->run = (scene_run){ .deck = &j->deck, .farm = j->farm };
  const int code = files_writable(&j->deck, &j->progress);
  if (code != DONE || watch(j) != DONE || !estimate_fits(&j->deck, j->farm, &j->progress))
    return FAILED;
  if (estimate_dry_run(&j->run, j->scene, &j->progress) != DONE) return FAILED;
  if (signals_stop(NULL)) return STOPPED;
  if (check_stdout(j) != DONE) return FAILED;
  return scene_failures_told(&j->run, "of those that were tried", &j->progress)
           ? SOME_POINTS_FAILED : DONE;
}

static int open_log(job *j)
{
  char why[FILE_WORDS];
  if (j->options.log == NULL || j->progress.log != NULL) return DONE;
  const int log = file_open(j->options.log, FILE_OWN, 0, why);
  if (log >= 0) j->progress.log = fdopen(log, "a");
  if (j->progress.log != NULL) return DONE;
  progress_error(&j->progress, "the log: %s", log < 0 ? why : strerror(errno));
  return FAILED;
}

static int start_farm(job *j)
{
  const char *why = NULL; /* it was told when the deck was read */
  if (scene_precision(&j->deck, &j->precision, &why) != PENDRES_OK) return BAD_USAGE;
  const farm_options options = { .library = j->precision,
                                 .threads = j->options.threads,
                                 .budget = j->options.budget,
                                 .stop = signals_stop,
                                 .run = ++j->turn,
                                 .progress = &j->progress };
  if (farm_create(&options, &j->farm) == PENDRES_OK) return DONE;
  progress_error(&j->progress, "out of memory for threads");
  return FAILED;
}

/* The output is found unwritable before anything is computed. */
static int open_output(job *j)
{
  char title[DECK_TITLE + 32], history[4 * DECK_PATH], source[64], references[SCENE_REFERENCES];
  const deck *d = &j->deck;
  const char *slash = strrchr(d->name, '/');
  snprintf(title, sizeof title, "%s", d->title[0] != '\0' ? d->title : deck_kind_name(d->kind));
  snprintf(history, sizeof history, "%s: resonance %.900s%s%.3000s", j->provenance.date,
           slash != NULL ? slash + 1 : d->name, d->settings[0] != '\0' ? " " : "", d->settings);
  snprintf(source, sizeof source, "resonance, libpendres %s", pendres_version());
  const pendres_store_options options = { .title = title, .history = history, .source = source,
                                          .references = scene_references(d, references),
                                          .alone = journal_alone(j->journal) };
  j->run = (scene_run){ .deck = d, .farm = j->farm };
  if (watch(j) != DONE) return FAILED;
  char output[DECK_PATH + SHARD_NAME], suffix[SHARD_NAME] = "";
  if (j->options.shards > 0) shard_suffix(j->options.shard, j->options.shards, suffix);
  snprintf(output, sizeof output, "%s%s", d->output, suffix);
  if (together_helping()) together_output(output, sizeof output);
  else if (options.alone) files_drop_whole(d, output);
  if (pendres_store_create(output, &options, &j->run.store) != PENDRES_OK) {
    const char *why = pendres_store_message(j->run.store);
    progress_error(&j->progress, "%s", *why != '\0' ? why : "out of memory for the output");
    return FAILED;
  }
  /* What a part of a run or another rank is killed with is of no use: its file has no name, unless
     that alone can tell others that it is in use. */
  if (together_helping() || (j->options.shards > 0 && options.alone))
    pendres_store_drop_part(j->run.store);
  const int opened = text_open(&j->table);
  j->run.table = j->table.stream;
  if (opened) return DONE;
  progress_error(&j->progress, "out of memory for the table of results");
  return FAILED;
}

static int open_journal(job *j)
{
  const options *o = &j->options;
  int code = files_writable(&j->deck, &j->progress);
  if (code == DONE && !estimate_fits(&j->deck, j->farm, &j->progress)) code = FAILED;
  if (code == DONE) code = resume_open(&j->deck, o, &j->progress, &j->journal);
  farm_set_journal(j->farm, j->journal);
  if (o->shards > 0)
    farm_set_share(j->farm, (farm_share){ .shard = o->shard - 1, .shards = o->shards });
  else if (o->merge && !o->resume) farm_set_share(j->farm, (farm_share){ .complete = 1 });
  return code;
}

/* A part has done its own, and writes no results. */
static int leave_part(job *j)
{
  const options *o = &j->options;
  const size_t lost = farm_points_lost(j->farm), own = journal_own(j->journal);
  journal_stay(j->journal);
  progress_note(&j->progress, "part %zu of %zu is done: %zu finished task%s in %s; when all parts "
                "are, the same command with --merge instead of --shard writes %s", o->shard,
                o->shards, own, own == 1 ? "" : "s", journal_path(j->journal), j->deck.output);
  if (lost == 0) return DONE;
  progress_error(&j->progress, "%zu point%s ended by --budget, and %s to --merge --resume", lost,
                 lost == 1 ? " was" : "s were", lost == 1 ? "is left" : "are left");
  return SOME_POINTS_FAILED;
}

/* What was asked for and has no effect: a budget where points have none, and, where orbits are
   wanted, a method that is not of fixed steps. */
static void tell_without_effect(job *j)
{
  const char *method = j->deck.precision.method;
  if (j->options.budget > 0.0 && !j->scene->budget)
    progress_note(&j->progress, "--budget has no effect on scenes of this kind; "
                  "precision.period_budget limits the drive periods of a pendulum");
  if (method[0] == '\0' || strcmp(method, "block_fixed") == 0) return;
  if (j->scene->any_method) return;
  progress_note(&j->progress, "method '%s' advances and settles pendulums; orbits and their "
                "measures are by fixed steps", method);
}

static int compute(job *j)
{
  progress_note(&j->progress, "%s: %s on %d thread%s", j->deck.name, deck_kind_name(j->deck.kind),
                farm_threads(j->farm), farm_threads(j->farm) == 1 ? "" : "s");
  tell_without_effect(j);
  pendres_status status = scene_run_all(&j->run, j->scene);
  farm_dismiss(j->farm, status == PENDRES_OK || status == PENDRES_INTERRUPTED ? NULL
               : progress_words(j->run.message, status));
  scene_write_identity(&j->run);
  scene_tell_units(&j->run);
  status = j->run.status;
  if (status == PENDRES_OK || farm_left(j->farm)) return DONE;
  if (status == PENDRES_INTERRUPTED) {
    const char *signal = signals_name();
    char advice[JOURNAL_WORDS];
    (void)resume_advice(j->journal, advice, sizeof advice);
    progress_error(&j->progress, "stopped by %s; %s", signal != NULL ? signal : "request",
                   advice[0] != '\0' ? advice : "nothing was written");
    return STOPPED;
  }
  progress_error(&j->progress, "%s", progress_words(j->run.message, status));
  return FAILED;
}

/* After a failure. */
static void tell_kept(job *j)
{
  char advice[JOURNAL_WORDS];
  (void)resume_advice(j->journal, advice, sizeof advice);
  if (advice[0] != '\0') progress_note(&j->progress, "%s", advice);
}

static int finish_output(job *j)
{
  pendres_store *store = j->run.store;
  pendres_status status =
    provenance_write(&j->provenance, &j->deck, j->farm, j->run.failed_points, store);
  files_kept kept = { 0 };
  if (status == PENDRES_OK && !j->options.force &&
      files_keep(&j->deck, &kept, &j->progress) != DONE)
    return FAILED;
  if (status == PENDRES_OK) status = pendres_store_close(store);
  files_keep_end(&kept, status == PENDRES_OK, &j->progress);
  if (status != PENDRES_OK) {
    progress_error(&j->progress, "%s", progress_words(pendres_store_message(store), status));
    return FAILED;
  }
  ending_whole();
  resume_leave(j->journal, farm_points_lost(j->farm), &j->progress);
  j->journal = NULL;
  return DONE;
}

static int report(job *j)
{
  if (!text_whole(&j->table)) {
    progress_error(&j->progress, "out of memory for the table of results, which are whole in %s",
                   j->deck.output);
    return FAILED;
  }
  if (j->options.deck_count > 1) {
    safe_text_write(stdout, j->deck.name);
    puts(":");
  }
  (void)fwrite(j->table.data, 1, j->table.size, stdout);
  progress_note(&j->progress, "%s written after %.2f s", j->deck.output,
                provenance_wall(&j->provenance));
  if (check_stdout(j) != DONE) return FAILED;
  if (j->progress.log != NULL && ferror(j->progress.log)) {
    progress_error(&j->progress, "the log %s is not whole", j->options.log);
    return FAILED;
  }
  char where[DECK_PATH + 20];
  snprintf(where, sizeof where, "as marked in %s", j->deck.output);
  return scene_failures_told(&j->run, where, &j->progress) ? SOME_POINTS_FAILED : DONE;
}

/* What is asked about decks, not of one. */
static int answer(const options *o)
{
  char why[200];
  pendres_status status = PENDRES_OK;
  if (o->action == OPTIONS_LIST) deck_list(stdout);
  else if (o->action == OPTIONS_REFERENCE) deck_reference(stdout);
  else if (o->action == OPTIONS_INIT) status = deck_init(o->word, stdout, why, sizeof why);
  else {
    status = deck_explain(o->word, stdout, why, sizeof why);
    if (pages_tell(o->word, status == PENDRES_OK, stdout) > 0) status = PENDRES_OK;
  }
  if (status == PENDRES_OK) return options_written(stdout);
  fputs("resonance: error: ", stderr);
  safe_text_write(stderr, why);
  fputs("\n", stderr);
  return BAD_USAGE;
}

/* A store that is not closed by now is given up, without a trace. */
static void let_go(job *j)
{
  scene_room_end(&j->run.room);
  pendres_store_free(j->run.store);
  j->run.store = NULL;
  j->run.table = NULL;
  text_drop(&j->table);
  farm_free(j->farm);
  j->farm = NULL;
  journal_close(j->journal);
  j->journal = NULL;
  deck_free(&j->deck);
}

static void let_go_all(job *j)
{
  let_go(j);
  for (size_t i = 0; i < j->options.deck_count && j->decks != NULL; i++) deck_free(&j->decks[i]);
  free(j->decks);
  if (j->progress.log != NULL) (void)fclose(j->progress.log);
}

/* The steps of a run. */
static int run_deck(job *j)
{
  int code = DONE;
  if (j->options.action == OPTIONS_DUMP_NAMELIST) return dump(j);
  provenance_start(&j->provenance);
  code = find_scene(j);                                              /* 3 its scene */
  if (code == DONE) code = start_farm(j);                            /* 4 threads */
  if (code == DONE && signals_install() != 0) code = FAILED;         /* 5 signals */
  if (j->options.action == OPTIONS_DRY_RUN) return code == DONE ? look_ahead(j) : code;
  if (code == DONE && !together_helping()) code = open_log(j);       /* 6 the log */
  if (code == DONE && !together_helping()) code = open_journal(j);   /* 7 what is done already */
  if (code == DONE) code = open_output(j);                           /* 8 the file */
  code = agree(j, code);
  if (code == DONE) code = compute(j);                               /* 9 all the work */
  if (together_helping()) return DONE;
  if (code == DONE && j->options.shards > 0) return leave_part(j);
  if (code == DONE) code = finish_output(j);                         /* 10 whole, in its place */
  if (code == FAILED) tell_kept(j);
  if (code == DONE && j->options.csv) code = csv_write(&j->deck, j->options.force, &j->progress);
  if (code == DONE) code = report(j);                                /* 11 the table */
  return code;
}

/* What is told of several decks: the worst. A failure is worse than points that failed. */
static int worse(int one, int other)
{
  static const int order[] = { DONE, SOME_POINTS_FAILED, FAILED, BAD_USAGE, STOPPED };
  int code = DONE;
  for (size_t i = 0; i < sizeof order / sizeof *order; i++)
    if (one == order[i] || other == order[i]) code = order[i];
  return code;
}

/* One deck after another, on a thread of its own. One that fails leaves the others their turn. */
static int run_decks(void *arg)
{
  job *j = arg;
  int code = together_helping() ? await_decks(j) : read_decks(j);    /* 2 the decks */
  code = agree(j, code);
  if (code != DONE) return code;
  for (size_t i = 0; i < j->options.deck_count; i++)
    if (!together_deck(&j->decks[i])) {
      progress_error(&j->progress, "%s: out of memory", j->options.deck[i]);
      return FAILED;
    }
  for (size_t i = 0; i < j->options.deck_count && !together_agree(code == STOPPED); i++) {
    if (i > 0) let_go(j);
    j->deck = j->decks[i];
    j->decks[i] = (deck){ 0 };
    code = worse(code, run_deck(j));
  }
  return code;
}

static int run_program(int argc, char **argv)
{
  job j = { 0 };
  int code = options_parse(argc, argv, &j.options);                  /* 1 the command line */
  if (code != DONE) return code;
  if (j.options.action == OPTIONS_HELP) return options_print_help(stdout);
  if (j.options.action == OPTIONS_VERSION) return options_print_version(stdout);
  if (j.options.action == OPTIONS_VERIFY)
    return verify_files(j.options.deck, j.options.deck_count);
  if (j.options.action >= OPTIONS_LIST) return answer(&j.options);
  progress_init(&j.progress, stderr, j.options.quiet);
  code = farm_run_on_thread(run_decks, &j);
  ending_told(code);
  let_go_all(&j);
  ending_done();
  return code;
}

int main(int argc, char **argv)
{
  char words[RANKS_WORDS];
  if (hold_streams() != DONE) return FAILED;
  keep_freed_memory();
  if (!ranks_start(&argc, &argv, words)) {
    fprintf(stderr, "resonance: error: %s\n", words);
    ranks_end();
    return FAILED;
  }
  if (together_helping()) together_silence();
  const int code = together_agree(run_program(argc, argv)); /* no rank ends before rank 0 */
  ranks_end();
  return code;
}
