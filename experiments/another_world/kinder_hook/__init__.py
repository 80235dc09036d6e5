"""KinDER's hook world for affcli: motor schemas, observation, bookkeeping; nothing that learns.

KinDER's unit is 10 in of ours: its hook is then 14 in long, and the box of babbling and the
distances of the paper's behaviors fit as they are.
"""
