"""Turn knobs and see what a driven oscillator does, in the browser: python3 -m pendres.explorer.

Owns: a page served on this machine alone (`__main__`), its knobs (`settings`), what they show
(`views`, computed by the library), how that is drawn (`figures` in the browser, `pictures` in a
file), work that ends when it is out of date (`newest`), and files of results (`results`). Needs
panel and bokeh, which the extra `explorer` of the package brings along.
"""
