"""What a test asks the Blackboard, whatever else its system is made of."""

from ros_processes import LIMIT


class BlackboardAccess:
    """For systems that have `rospy`, `msg` and `srv`."""

    def ask(self, service, kind, **fields):
        self.rospy.wait_for_service('blackboard/' + service, LIMIT)
        answer = self.rospy.ServiceProxy('blackboard/' + service, kind)(**fields)
        assert answer.error.code == 0, answer.error.message
        return answer

    def episodes(self):
        return self.ask('list_episodes', self.srv.ListEpisodes).episodes

    def fluents(self, concept, now=False, **fields):
        """Of this concept and below: those that hold, or all that ever held."""
        kind = self.msg.FluentQuery.NOW if now else self.msg.FluentQuery.EVER
        query = self.msg.FluentQuery(below=[concept], time_kind=kind, **fields)
        return self.ask('query', self.srv.QueryFluents, query=query).fluents
