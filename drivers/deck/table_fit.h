/* table_fit.h -- rows of deck_table: keys of &data and &fit. For table.c alone, within its list. */
  { STRING("data", "file", data.file), NEEDED_IN(FIT), EXAMPLE("'fit.csv'"),
    SAYS(NULL, "text file of the data, one datum on each line: numbers with commas, semicolons, "
         "tabs or blanks between them; a line of names may come first; # and ! begin comments. The "
         "path is from the deck's folder. Or a file of results, whose variables are the columns") },
  { CHOICES("data", "columns", data.columns), IN(FIT),
    SAYS(NULL, "columns of the file by name or number: the axis, the observables, then their "
         "standard errors (all or none), then the direction (1, -1, up, down); ROLE=COLUMN says "
         "what a column is in any place, as 'drive_amplitude=4' for a parameter that differs "
         "between sweeps. Without it the names in the file's first line are taken for roles: those "
         "of axis and observables, OBSERVABLE_error, direction, and names of parameters") },
  { CHOICES("data", "units", data.units), IN(FIT), .repeats = 1,
    SAYS(NULL, "units of these columns in their order, as 'GHz', 'dB', 'deg'; '1': of a number. "
         "Without it they are those in the file, behind names or in a line of their own. Numbers "
         "with a unit become SI: Hz, V, rad, and of dB an amplitude") },
  { CHOICE("data", "format", data.format), IN(FIT), .choices = formats, .text = "any",
    SAYS(NULL, "what the file is, where its content does not tell it; docs/fit.md") },
  { CHOICE("data", "decimal", data.decimal), IN(FIT), .choices = decimals, .text = "point",
    SAYS(NULL, "what stands before the decimals; with a comma cells are not separated by commas") },
  { REAL("data", "loss", data.loss), IN(FIT), RANGE(-300, 300), .number = 0,
    SAYS("dB", "what is lost of drives in dBm on their way to the oscillator") },
  { INTEGER("data", "time_sign", data.time_sign), IN(FIT), RANGE(-1, 1), .number = 0,
    SAYS(NULL, "sign of i w t in the complex numbers of the data, 1 or -1; 0: 1 of an s_parameter, "
         "and -1 of in_phase and quadrature, whose quadrature is then R sin(lag)") },
  { CHOICE("data", "axis", data.axis), IN(FIT), .choices = swept, .text = "drive_frequency",
    SAYS(NULL, "parameter that was swept; 'time': the data are a free decay, without drive") },
  { CHOICES("data", "observable", data.observables), IN(FIT), .choices = observables,
    EXAMPLE("'amplitude'"),
    SAYS(NULL, "what was measured, in the order of the columns; without it 'amplitude', of data "
         "over time 'displacement'") },
  { CHOICE("data", "direction", data.direction), IN(FIT), .choices = directions, .text = "file",
    SAYS(NULL, "which way the axis went where no column says it: as the lines of the file do, or "
         "up or down throughout") },
  { REAL("data", "error", data.error), IN(FIT), NOT_NEGATIVE, .number = 0,
    SAYS("unit of the data", "standard error of each datum where no column has it, in its unit") },
  { REAL("data", "relative_error", data.relative_error), IN(FIT), NOT_NEGATIVE, .number = 0,
    IS(NUMBER, "standard error as a share of the datum, added to 'error' in squares; without "
         "either, errors follow from the scatter about the fit") },

  { CHOICES("fit", "free", fit.free), NEEDED_IN(FIT), .choices = quantities,
    EXAMPLE("'damping', 'drive_amplitude', 'frequency_scale'"),
    SAYS(NULL, "quantities that are sought: parameters, whose values in &pendulum are guesses, and "
         "scales of the instrument (docs/fit.md). What has no guess is guessed from the data") },
  { CHOICES("fit", "fixed", fit.fixed), IN(FIT),
    SAYS(NULL, "quantities with other values than &pendulum has, as 'amplitude_scale 0.2'; without "
         "it scales are 1, offset and backgrounds 0") },
  { CHOICES("fit", "bounds", fit.bounds), IN(FIT),
    SAYS(NULL, "bounds of what is free, as 'damping 0.01 0.1' or, with &units, 'damping 1 9 kHz'")},
  { CHOICES("fit", "prior", fit.prior), IN(FIT),
    SAYS(NULL, "what is known of free quantities beside the data, a mean and its standard error, "
         "as 'a3 -0.16 0.01'") },
  { CHOICE("fit", "model", fit.model), IN(FIT), .choices = line_models, .text = "",
    SAYS(NULL, "how an s_parameter follows from the motion: through the oscillator, past it, or "
         "back from it") },
  { REAL("fit", "huber", fit.huber), IN(FIT), NOT_NEGATIVE, .number = 0,
    IS(NUMBER, "standard errors beyond which a residual counts by its size instead of its square, "
         "against outliers; 0: none does") },
  { REAL("fit", "jump_error", fit.jump_error), IN(FIT), NOT_NEGATIVE, .number = 0,
    SAYS("unit of the data", "standard error of the axis at which jumps were seen, beside the "
         "spacing of the data: noise makes states jump early") },
  { INTEGER("fit", "starts", fit.starts), IN(FIT), RANGE(1, 100), .number = 20,
    SAYS(NULL, "most guesses that are tried, until one fits well") },
  { INTEGER("fit", "iterations", fit.iterations), IN(FIT), RANGE(1, 10000), .number = 60,
    SAYS(NULL, "most steps from each guess") },
