FiveBar=None
