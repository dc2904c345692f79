#!/usr/bin/env python3
"""Compare the deck reader with gfortran's namelist reader.

    python3 tests/namelist_conformance/compare.py [-v]

from the top of the tree. Needs python3 (its standard library), a C compiler (CC) and gfortran (FC).
Exit code 0: every case behaves as labelled; 1: some do not; 77: no gfortran here.

Labels: 'agree': both read the same values, or both refuse. 'stricter': gfortran accepts what we
refuse, by choice, since it hides mistakes. 'quirk': gfortran refuses, or reads otherwise, what we
read as the standard says (or as harmless input deserves). 'varies': releases of gfortran differ.
The values expected of us stand with each case, so that a label says something even if gfortran
changes its mind.
"""
import glob
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))
ERROR = None

# label, name, text, what we read (ERROR: refused)
CASES = [
    ('agree', 'scalars', "&g i=3 x=1.5 l=T s='abc' /\n", {'i(1)': 3, 'x(1)': 1.5, 'l(1)': 'T', 's(1)': 'abc'}),
    ('agree', 'case of names', "&G XV = 1.0, I=2 /\n", {'xv(1)': 1.0, 'i(1)': 2}),
    ('agree', 'exponents', "&g xv=1d3 2.5D-1 1e+2 1.5+3 2-1 /\n",
     {'xv(1)': 1e3, 'xv(2)': 0.25, 'xv(3)': 100.0, 'xv(4)': 1500.0, 'xv(5)': 0.2}),
    ('agree', 'points', "&g xv=1. .5 -.5 +3 -0. /\n",
     {'xv(1)': 1.0, 'xv(2)': 0.5, 'xv(3)': -0.5, 'xv(4)': 3.0, 'xv(5)': -0.0}),
    ('agree', 'special numbers', "&g xv=inf -Infinity nan +INF NaN(0x1) /\n",
     {'xv(1)': float('inf'), 'xv(2)': float('-inf'), 'xv(3)': float('nan'), 'xv(4)': float('inf'),
      'xv(5)': float('nan')}),
    ('agree', 'digits', "&g xv=0.20000000000000001 3.14159265358979323846264338 1e-300 1e308 123456789012345678901234567890/\n",
     {'xv(1)': 0.2, 'xv(2)': 3.141592653589793, 'xv(3)': 1e-300, 'xv(4)': 1e308, 'xv(5)': 123456789012345678901234567890.0}),
    ('agree', 'repeats', "&g xv=2*1.5, 3*0 /\n", {'xv(1)': 1.5, 'xv(2)': 1.5, 'xv(3)': 0.0, 'xv(4)': 0.0, 'xv(5)': 0.0}),
    ('agree', 'repeated nulls', "&g xv=2* 7 /\n", {'xv(3)': 7.0}),
    ('agree', 'nulls', "&g xv=1,,3, , 5 /\n", {'xv(1)': 1.0, 'xv(3)': 3.0, 'xv(5)': 5.0}),
    ('agree', 'leading null', "&g xv=,2 /\n", {'xv(2)': 2.0}),
    ('agree', 'trailing comma', "&g xv=1,2, /\n", {'xv(1)': 1.0, 'xv(2)': 2.0}),
    ('agree', 'trailing comma before a name', "&g xv=1,2, i=3 /\n", {'xv(1)': 1.0, 'xv(2)': 2.0, 'i(1)': 3}),
    ('agree', 'empty value', "&g x= i=3 /\n", {'i(1)': 3}),
    ('agree', 'logicals', "&g lv=.true. .F. tomato l=.f /\n", {'lv(1)': 'T', 'lv(2)': 'F', 'lv(3)': 'T', 'l(1)': 'F'}),
    ('agree', 'logical that is none', "&g l=1 /\n", ERROR),
    ('agree', 'strings', "&g sv='it''s', \"a\"\"b\", 'a/b!c&d' /\n", {'sv(1)': "it's", 'sv(2)': 'a"b', 'sv(3)': 'a/b!c&d'}),
    ('agree', 'string with blanks', "&g s='  two  words' /\n", {'s(1)': '  two  words'}),
    ('agree', 'string over two lines', "&g s='ab\ncd' /\n", {'s(1)': 'abcd'}),
    ('agree', 'UTF-8 in a string', "&g s='Pérez γ' /\n", {'s(1)': 'Pérez γ'}),
    ('agree', 'comments', "! head\n&g ! here\n i=3 ! there / &\n ! alone\n x=2 /\n! tail\n", {'i(1)': 3, 'x(1)': 2.0}),
    ('agree', 'comment without a blank', "&g i=3! there\n x=2 /\n", {'i(1)': 3, 'x(1)': 2.0}),
    ('agree', 'dollar', "$g i=3 $end\n", {'i(1)': 3}),
    ('agree', 'ampersand end', "&g i=3 &end\n", {'i(1)': 3}),
    ('agree', 'end in capitals', "&g i=3\n &END\n", {'i(1)': 3}),
    ('agree', 'CRLF', "&g i=3\r\n x=2\r\n/\r\n", {'i(1)': 3, 'x(1)': 2.0}),
    ('agree', 'tabs', "&g\ti\t=\t3\tx=2\t/\n", {'i(1)': 3, 'x(1)': 2.0}),
    ('agree', 'byte-order mark', "\ufeff&g i=3 /\n", {'i(1)': 3}),
    ('agree', 'element', "&g xv(3)=1.5 /\n", {'xv(3)': 1.5}),
    ('agree', 'slice', "&g xv(2:4)=1,2,3 /\n", {'xv(2)': 1.0, 'xv(3)': 2.0, 'xv(4)': 3.0}),
    ('agree', 'slice with step', "&g xv(1:5:2)=1,2,3 /\n", {'xv(1)': 1.0, 'xv(3)': 2.0, 'xv(5)': 3.0}),
    ('agree', 'slice with a negative step', "&g xv(5:1:-2)=1,2,3 /\n", {'xv(1)': 3.0, 'xv(3)': 2.0, 'xv(5)': 1.0}),
    ('agree', 'slice back, repeats', "&g xv(4:2:-1)=2*5,6 /\n", {'xv(2)': 6.0, 'xv(3)': 5.0, 'xv(4)': 5.0}),
    ('agree', 'slice back, too short', "&g xv(4:1:-2)=1,2,3 /\n", ERROR),
    ('agree', 'slice back, open', "&g xv(3::-1)=1,2,3 /\n", ERROR),
    ('agree', 'slice with signs', "&g xv(+1:+5:+2)=1,2,3 /\n", {'xv(1)': 1.0, 'xv(3)': 2.0, 'xv(5)': 3.0}),
    ('agree', 'open slice', "&g xv(4:)=1,2 /\n", {'xv(4)': 1.0, 'xv(5)': 2.0}),
    ('agree', 'element beyond', "&g xv(6)=1 /\n", ERROR),
    ('agree', 'element zero', "&g xv(0)=1 /\n", ERROR),
    ('agree', 'blanks in a subscript', "&g xv( 2 )=1 /\n", {'xv(2)': 1.0}),
    ('agree', 'blank before a subscript', "&g xv (2)=1 /\n", ERROR),
    ('agree', 'blank after the ampersand', "& g i=3 /\n", ERROR),
    ('agree', 'blank before the star', "&g xv=3 *1.5 /\n", ERROR),
    ('agree', 'kind suffix', "&g i=3_4 /\n", ERROR),
    ('agree', 'unknown name', "&g omgea=3 /\n", ERROR),
    ('agree', 'missing group', "&h i=3 /\n", ERROR),
    ('agree', 'missing slash', "&g i=3\n", ERROR),
    ('agree', 'integer with a point', "&g i=3.0 /\n", ERROR),
    ('agree', 'integer overflow', "&g i=9223372036854775808 /\n", ERROR),
    ('agree', 'number that is none', "&g x=abc /\n", ERROR),
    ('agree', 'hexadecimal', "&g x=0x10 /\n", ERROR),
    ('agree', 'two points', "&g x=1.2.3 /\n", ERROR),
    ('agree', 'exponent without digits', "&g x=1e /\n", ERROR),
    ('agree', 'too many values', "&g iv=1,2,3,4,5,6 /\n", ERROR),
    ('agree', 'two values for a scalar', "&g x=1,2 /\n", ERROR),
    ('agree', 'unterminated string', "&g s='abc /\n", ERROR),
    ('agree', 'unquoted string', "&g s=abc /\n", ERROR),
    ('agree', 'hash comment', "&g i=3 # text\n/\n", ERROR),
    ('agree', 'complex', "&g x=(1,2) /\n", ERROR),
    ('agree', 'zero repeat', "&g xv=0*1 /\n", ERROR),
    ('agree', 'two equals signs', "&g x==1 /\n", ERROR),
    ('agree', 'missing equals sign', "&g x 1 /\n", ERROR),
    ('agree', 'component', "&g x%y=1 /\n", ERROR),
    ('agree', 'name on its own line', "&g\nx\n=\n1\n/\n", {'x(1)': 1.0}),
    ('agree', 'other groups around', "&a z=1 /\n&g x=1 /\n&b z=1 /\n", {'x(1)': 1.0}),
    ('agree', 'groups on one line', "&a z=1 / &g x=1 /\n", {'x(1)': 1.0}),

    ('stricter', 'overflow', "&g x=1e400 /\n", ERROR),
    ('stricter', 'underflow', "&g x=1e-400 /\n", ERROR),
    ('stricter', 'element with two values', "&g xv(4)=5,6 /\n", ERROR),
    ('stricter', 'exponent letter q', "&g x=1.5q-3 /\n", ERROR),
    ('stricter', 'text between groups', "hello\n&g x=1 /\n", ERROR),
    ('stricter', 'slash in a number', "&g xv=1/2 /\n", ERROR),
    ('stricter', 'text after the slash', "&g x=1 / hello\n", ERROR),
    ('stricter', 'group twice', "&g x=1 /\n&g x=2 /\n", ERROR),
    ('stricter', 'name twice', "&g x=1 x=2 /\n", ERROR),
    ('stricter', 'element twice', "&g xv=1,2,3 xv(2)=5 /\n", ERROR),
    ('stricter', 'string over a line like a group', "&g s='ab\n/ cd' /\n", ERROR),
    ('stricter', 'string over a line like an assignment', "&g s='ab\ni = 3' /\n", ERROR),

    ('varies', 'semicolon', "&g xv=1;2;3 /\n", ERROR),  # accepted by 12, refused by 14

    ('quirk', 'no newline at the end', "&g i=3 /", {'i(1)': 3}),
    ('quirk', 'comment right after a comma', "&g xv=1,! one\n 2 /\n", {'xv(1)': 1.0, 'xv(2)': 2.0}),
]

# Decks of every kind; the dump of each must mean the same to gfortran and to us.
DECKS = {
    'free_oscillation': "&scene kind='free_oscillation' /\n&sweep amplitude=0.1,3.1 amplitude_range=0.05,3,60 /\n",
    'resonance_curve': "&scene kind='resonance_curve', title='Fig. 2: it''s' /\n&pendulum drive_amplitude=0.2 /\n"
                       "&sweep damping=0.165,0.24,0.32 damping_range=0.06,1.0,95 drive_frequency_range=0.5,1.2 /\n"
                       "&precision tolerance=1e-8 /\n",
    'response': "&scene kind='response' /\n&pendulum drive_amplitude=0.2 temperature=1e-4 /\n"
                "&sweep damping=0.24,0.32 drive_period_range=5,10,101 /\n&noise seed=9223372036854775807 /\n",
    'orbit': "&scene kind='orbit' /\n&pendulum drive_amplitude=0.2 damping=0.12 drive_period=8 /\n&orbit start='la' /\n",
    'orbit_start': "&scene kind='orbit' /\n&pendulum drive_amplitude=0.2 damping=0.12 drive_frequency=0.785 /\n"
                   "&orbit x=1 v=-0.3333333333333333 transient=T /\n",
    'basins': "&scene kind='basins' /\n&pendulum drive_amplitude=0.2 damping=0.12 drive_period=8 /\n"
              "&sweep x_range=-1.5707963,4.712388,1024 v=%s temperature=1e-4,1e-3 /\n"
              "&basins boundary=.true. seed=12345678901 /\n" % ', '.join(repr(k / 7) for k in range(60)),
    'phase_diagram': "&scene kind='phase_diagram' /\n&pendulum drive_amplitude=0.2 /\n"
                     "&sweep damping_range=0.06,0.2,200 drive_frequency_range=0.7,0.9,200 /\n",
    'branches': "&scene kind='branches' /\n&pendulum drive_amplitude=0.2 /\n"
                "&sweep damping=0.13,0.14,0.15 drive_frequency_range=0.7,0.9,200 /\n",
    'work_precision': "&scene kind='work_precision' /\n&sweep method='block_fixed','gsl_rk8pd' tolerance=1e-4,1e-13\n"
                      " unit='sweep' /\n",
    'hard_cases': "&scene kind='hard_cases', output='a b.h5' /\n&sweep case='separatrix', 'tolerance' /\n",
    'outer': "&scene kind='basins' /\n&pendulum drive_amplitude=0.2 damping=0.12 drive_period=8 force='polynomial' force_coefficients=1 /\n"
             "&sweep x_range=-1,1,8 v_range=-1,1,8 /\n&outer key='a3' values=0.1 values_range=0.3,0.7,3 /\n",
    'switching': "&scene kind='switching' /\n&pendulum drive_amplitude=0.2 damping=0.12 drive_period=8 /\n"
                 "&sweep temperature_range=1e-3,1e-2,5 /\n",
}


def run(command, **kw):
    return subprocess.run(command, capture_output=True, text=True, encoding='utf-8', errors='replace', **kw)


def build(folder):
    cc = os.environ.get('CC', 'cc').split()
    sources = [os.path.join(HERE, 'ours.c')] + sorted(glob.glob(os.path.join(TOP, 'drivers', 'deck', '**', '*.c'), recursive=True))
    sources.append(os.path.join(TOP, 'drivers', 'terminal', 'safe_text.c'))
    sources += [os.path.join(TOP, 'drivers', 'system', f) for f in ('bytes.c', 'file.c', 'grow.c', 'text.c')]
    sources.append(os.path.join(TOP, 'src', 'analysis', 'sweeps', 'sweep.c'))  # what lists and ranges make of an axis
    # Which coefficients a force has, what its parameters are, and its units.
    sources += sorted(glob.glob(os.path.join(TOP, 'src', 'model', '**', '*.c'), recursive=True))
    sources.append(os.path.join(TOP, 'src', 'base', 'names.c'))  # of what a fit may free
    subprocess.run(cc + ['-std=c11', '-O1', '-I' + os.path.join(TOP, 'include'),
                         '-I' + os.path.join(TOP, 'src'),
                         '-I' + os.path.join(TOP, 'drivers'), '-o', folder + '/ours'] + sources + ['-lgsl', '-lgslcblas', '-lm'], check=True)


def fortran(folder, source, name):
    subprocess.run([os.environ.get('FC', 'gfortran'), '-O0', '-ffree-line-length-none', '-o', folder + '/' + name, source], check=True)


def value(text):
    """A printed value as something that compares: strings end with '|' (Fortran drops blanks before it)."""
    if text.endswith('|'):
        return text[:-1].rstrip(' ')
    if text in 'TF':
        return text
    try:
        return int(text)
    except ValueError:
        return float(text)


def same(a, b):
    if isinstance(a, float) or isinstance(b, float):
        if isinstance(a, str) or isinstance(b, str):
            return False
        return repr(float(a)) == repr(float(b))  # so that nan is nan, and -0.0 not 0.0
    return a == b


def same_values(a, b):
    if a is None or b is None:
        return a is b
    return a.keys() == b.keys() and all(same(a[k], b[k]) for k in a)


def values(result):
    """What a program read, or ERROR."""
    if result.returncode != 0:
        return ERROR
    return {k: value(v) for k, v in (line.strip().split(' ', 1) for line in result.stdout.splitlines())}


def check_cases(folder, verbose):
    bad = 0
    path = folder + '/case.nml'
    for label, name, text, wanted in CASES:
        with open(path, 'w', encoding='utf-8', newline='') as f:
            f.write(text)
        ours = run([folder + '/ours', 'read', path])
        theirs = run([folder + '/theirs', path])
        a, b = values(ours), values(theirs)
        good = same_values(a, wanted)
        if label == 'agree':
            good = good and same_values(a, b)
        elif label == 'stricter':
            good = good and a is ERROR and b is not ERROR
        elif label == 'quirk':
            good = good and not same_values(a, b)
        bad += not good
        if verbose or not good:
            print('%-5s %-9s %s' % ('ok' if good else 'WRONG', label, name))
        if not good:
            print('   ', repr(text), '\n    ours', a, ours.stderr.strip(), '\n    theirs', b, theirs.stderr.strip())
    print('%d cases, %d not as labelled' % (len(CASES), bad))
    return bad


def reader_source(keys):
    """A Fortran program that reads all groups of a deck, declared from our table of keys."""
    kinds = {'integer': 'integer(8)', 'real': 'real(8)', 'logical': 'logical', 'string': 'character(1100)'}
    unset = {'integer': '-987654321', 'real': '-987654321d0', 'string': "'<unset>'"}
    groups = {}
    for line in keys.splitlines():
        group, name, kind = line.split()
        groups.setdefault(group, {})[name] = kind
    out = ['program reader', '  implicit none', '  character(400) :: path', '  call get_command_argument(1, path)']
    out += ['  call read_%s()' % g for g in groups] + ['contains']
    for group, names in groups.items():
        out += ['  subroutine read_%s()' % group, '    integer :: k_, status_, pass_', '    character(400) :: message_']
        out += ['    %s :: %s(100)%s' % (kinds[k], n, ', %s_1(100)' % n if k == 'logical' else '')
                for n, k in names.items()]
        out += ['    namelist /%s/ %s' % (group, ', &\n      '.join(names)), '    do pass_ = 1, 2']
        out += ['      %s = %s' % (n, unset.get(k, 'pass_ == 1')) for n, k in names.items()]
        out += ["      open(10, file=path, status='old', action='read')",
                '      read(10, nml=%s, iostat=status_, iomsg=message_)' % group, '      close(10)',
                '      if (status_ == -1) return  ! the deck has no such group',
                "      if (status_ /= 0) then", "        write(0, '(a)') trim(message_)", '        call exit(1)', '      end if']
        out += ['      if (pass_ == 1) %s_1 = %s' % (n, n) for n, k in names.items() if k == 'logical']
        out += ['    end do', '    do k_ = 1, 100']
        for n, k in names.items():
            label = "'%s.%s(', k_, ') '" % (group, n)
            if k == 'logical':
                out += ['      if (%s(k_) .eqv. %s_1(k_)) print \'(a,i0,a,l1)\', %s, %s(k_)' % (n, n, label, n)]
            elif k == 'string':
                out += ["      if (%s(k_) /= '<unset>') print '(a,i0,3a)', %s, trim(%s(k_)), '|'" % (n, label, n)]
            else:
                form = 'i0' if k == 'integer' else 'es25.17e3'
                out += ["      if (.not. %s(k_) == %s) print '(a,i0,a,%s)', %s, %s(k_)" % (n, unset[k], form, label, n)]
        out += ['    end do', '  end subroutine']
    return '\n'.join(out + ['end program reader']) + '\n'


def check_decks(folder, verbose):
    bad = 0
    source = folder + '/reader.f90'
    with open(source, 'w') as f:
        f.write(reader_source(run([folder + '/ours', 'keys']).stdout))
    fortran(folder, source, 'reader')
    for name, text in DECKS.items():
        deck, dumped = folder + '/%s.nml' % name, folder + '/%s.dump' % name
        with open(deck, 'w') as f:
            f.write(text)
        dump = run([folder + '/ours', 'dump', deck])
        with open(dumped, 'w') as f:
            f.write(dump.stdout)
        a, b = values(run([folder + '/ours', 'deck', dumped])), values(run([folder + '/reader', dumped]))
        again = run([folder + '/ours', 'dump', dumped])
        good = dump.returncode == 0 and bool(a) and same_values(a, b) and again.stdout == dump.stdout
        bad += not good
        if verbose or not good:
            print('%-5s dump      %s: %d values' % ('ok' if good else 'WRONG', name, len(a or {})))
        if not good:
            print(dump.stderr, dump.stdout, again.stderr)
            for k in sorted(set(a or {}) ^ set(b or {})):
                print('    only one side has', k)
            for k in sorted(set(a or {}) & set(b or {})):
                if not same(a[k], b[k]):
                    print('   ', k, a[k], b[k])
    print('%d dumps, %d read differently' % (len(DECKS), bad))
    return bad


def main():
    verbose = '-v' in sys.argv[1:]
    if shutil.which(os.environ.get('FC', 'gfortran')) is None:
        print('no gfortran: nothing to compare with')
        return 77
    with tempfile.TemporaryDirectory() as folder:
        build(folder)
        fortran(folder, os.path.join(HERE, 'theirs.f90'), 'theirs')
        bad = check_cases(folder, verbose) + check_decks(folder, verbose)
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
