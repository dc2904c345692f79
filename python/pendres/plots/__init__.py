"""Pictures of the files that the program writes, by matplotlib, for plots/plot.py and pendres.plot.

Owns: what each kind of scene looks like (`curves`, `maps`, `fits`, `validation`, of several values
`outer`), colours, sizes and axes (`style`), and which is drawn (`drawn`). Needs no library.
"""
