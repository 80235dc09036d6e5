"""What a person wrote in a TOML file: a tool, a behavior, tasks. Checked before anything is made of
it, and stored by value: a file that is changed later changes no run.
"""
