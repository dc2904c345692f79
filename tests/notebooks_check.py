"""Run the notebooks of docs/notebooks, cell by cell, as Jupyter would; what a cell shows is asked for,
and pictures are drawn. None holds outputs, which would be old some day."""
import ast
import json
import os
import sys
import time

os.environ["MPLBACKEND"] = "Agg"


def run(source, names, where):
    tree = ast.parse(source, where)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, where, "exec"), names)  # pylint: disable=exec-used
    if last is None:
        return
    shown = eval(compile(ast.Expression(last.value), where, "eval"), names)  # pylint: disable=eval-used
    if hasattr(shown, "savefig"):
        shown.savefig(os.devnull, format="svg")
    elif hasattr(shown, "_repr_html_"):
        assert shown._repr_html_()
    elif shown is not None and not source.rstrip().endswith(";"):
        print(repr(shown))


for path in sys.argv[1:]:
    start = time.process_time(), time.monotonic()
    with open(path, encoding="utf-8") as file:
        notebook = json.load(file)
    names = {"__name__": "__main__"}
    for number, cell in enumerate(notebook["cells"], 1):
        where = f"{os.path.basename(path)}, cell {number}"
        if cell["cell_type"] == "code":
            assert not cell["outputs"], f"{where} holds outputs: clear them"
            run("".join(cell["source"]), names, where)
    print(f"{path}: {time.monotonic() - start[1]:.1f} s")
